#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "timbre/analysis/core/array_file.h"

namespace timbre::cli {

struct NamedMatrix {
  std::string name;
  Eigen::MatrixXd values;
};

/// Several arrays in one file: `.mat` if its path ends so, else `.npz`.
[[nodiscard]] std::string to_archive(const std::string& path,
                                     const std::vector<NamedArray>& arrays);

/// Refuses what an archive cannot hold, before the work for it: 4 GiB in `.npz`, 2 GiB in `.mat`.
/// @param rows, columns  of the largest array
void require_fits(const std::string& path, Eigen::Index rows, Eigen::Index columns);

/// The bytes of a result file by the ending of its path: `.npy` holds the first matrix,
/// `.npz` and `.mat` all, `.txt` and `-` a row of the first matrix per line.
/// @throws Error  bad_request for another ending
[[nodiscard]] std::string to_file_bytes(const std::string& path,
                                        const std::vector<NamedMatrix>& matrices);

/// A row per line, shortest round-trip numbers parted by blanks.
[[nodiscard]] std::string to_rows_text(const Eigen::MatrixXd& values);

/// A list of rows.
[[nodiscard]] nlohmann::json to_json_rows(const Eigen::MatrixXd& values);

}  // namespace timbre::cli

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

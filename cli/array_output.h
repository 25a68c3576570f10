#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace timbre::cli {

struct NamedMatrix {
  std::string name;
  Eigen::MatrixXd values;
};

/// The bytes of a result file by the ending of its path: `.npy` holds the first matrix,
/// `.npz` all, `.txt` and `-` a row of the first matrix per line.
/// @throws Error  bad_request for another ending
[[nodiscard]] std::string to_file_bytes(const std::string& path,
                                        const std::vector<NamedMatrix>& matrices);

/// A row per line, shortest round-trip numbers parted by blanks.
[[nodiscard]] std::string to_rows_text(const Eigen::MatrixXd& values);

/// A list of rows.
[[nodiscard]] nlohmann::json to_json_rows(const Eigen::MatrixXd& values);

}  // namespace timbre::cli

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace timbre::cli {

struct NamedMatrix {
  std::string name;
  Eigen::MatrixXd values;
};

/// The bytes of a result file by the ending of its path: `.npy` holds the first matrix,
/// `.npz` all, anything else is text, a row of the first matrix per line.
[[nodiscard]] std::string to_file_bytes(const std::string& path,
                                        const std::vector<NamedMatrix>& matrices);

/// A row per line, shortest round-trip numbers parted by blanks.
[[nodiscard]] std::string to_rows_text(const Eigen::MatrixXd& values);

}  // namespace timbre::cli

#include "timbre/cli/array_output.h"

#include "timbre/analysis/core/mat_file.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/cli/options.h"

namespace timbre::cli {
namespace {

// One column is a vector to NumPy's users.
std::string npy_of(const Eigen::MatrixXd& values) {
  return values.cols() == 1 ? to_npy(Eigen::VectorXd(values.col(0))) : to_npy(values);
}

}  // namespace

std::string to_rows_text(const Eigen::MatrixXd& values) {
  std::string text;
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    for (Eigen::Index j = 0; j < values.cols(); ++j) {
      if (j > 0) text += ' ';
      text += to_text(values(i, j));
    }
    text += '\n';
  }
  return text;
}

nlohmann::json to_json_rows(const Eigen::MatrixXd& values) {
  nlohmann::json rows = nlohmann::json::array();
  for (const auto& row : values.rowwise()) {
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  }
  return rows;
}

std::string to_archive(const std::string& path, const std::vector<NamedArray>& arrays) {
  return array_format(path) == "mat" ? to_mat(arrays) : to_npz(arrays);
}

std::string to_file_bytes(const std::string& path, const std::vector<NamedMatrix>& matrices) {
  const std::string format = array_format(path);
  if (format == "npy") return npy_of(matrices.front().values);
  if (format == "txt") return to_rows_text(matrices.front().values);
  std::vector<NamedArray> arrays;
  arrays.reserve(matrices.size());
  for (const NamedMatrix& matrix : matrices) {
    arrays.push_back({matrix.name, npy_of(matrix.values)});
  }
  return to_archive(path, arrays);
}

}  // namespace timbre::cli

#include "timbre/cli/array_output.h"

#include "timbre/analysis/core/error.h"
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

void require_fits(const std::string& path, Eigen::Index rows, Eigen::Index columns) {
  if (path.empty()) return;
  const std::string format = array_format(path);
  if (format != "npz" && format != "mat") return;
  constexpr double kGigabyte = 1073741824.0;
  const double most = format == "mat" ? 2.0 : 4.0;
  const double bytes = 8.0 * static_cast<double>(rows) * static_cast<double>(columns);
  if (bytes < most * kGigabyte) return;
  throw Error(ErrorKind::bad_request, "", format,
              "holds at most " + to_text(most) + " GiB; write a .npy file");
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

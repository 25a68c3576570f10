#include "timbre/analysis/signatures/heat_kernel.h"

#include <cmath>
#include <numbers>
#include <string>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/matrix_product.h"

namespace timbre {
namespace {

Eigen::Index nonzero_count(const Spectrum& spectrum) {
  const Eigen::Index count = spectrum.values.size() - spectrum.zeros;
  if (count < 1) {
    throw Error(ErrorKind::bad_request, "", "spectrum",
                "holds no eigenvalue above zero; ask for more eigenpairs");
  }
  return count;
}

}  // namespace

Eigen::VectorXd heat_kernel_times(const Spectrum& spectrum, int count) {
  if (count < 1) {
    throw Error(ErrorKind::bad_request, "", "times",
                "asks for " + std::to_string(count) + " times; at least 1 is needed");
  }
  const Eigen::Index used = nonzero_count(spectrum);
  const double scale = std::log(4.0 * std::numbers::ln10);
  const double first = scale - std::log(spectrum.values(spectrum.values.size() - 1));
  const double last = scale - std::log(spectrum.values(spectrum.values.size() - used));
  return Eigen::VectorXd::LinSpaced(count, first, last).array().exp();
}

Eigen::MatrixXd compute_heat_kernel_signature(const Spectrum& spectrum,
                                              const Eigen::VectorXd& times,
                                              const HeatKernelOptions& options) {
  const Eigen::Index used = nonzero_count(spectrum);
  Eigen::MatrixXd decay = (-spectrum.values.tail(used) * times.transpose()).array().exp();
  if (options.divide_by_trace) {
    const Eigen::RowVectorXd trace = decay.colwise().sum();
    decay.array().rowwise() /= trace.array();
  }
  return product_a_b(spectrum.vectors.rightCols(used).cwiseAbs2(), decay);
}

}  // namespace timbre

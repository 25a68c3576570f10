#include "timbre/analysis/filter/transfer.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"

namespace timbre {
namespace {

Error bad_transfer(const std::string& cause) {
  return {ErrorKind::bad_request, "", "transfer", cause};
}

void require_ascending(const Eigen::MatrixX2d& points) {
  if (points.rows() == 0) throw Error(ErrorKind::bad_input, "", "transfer", "has no points");
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const std::string place = "point " + std::to_string(i);
    if (!points.row(i).allFinite()) {
      throw Error(ErrorKind::bad_input, "", place, "is not finite");
    }
    if (i > 0 && points(i, 0) <= points(i - 1, 0)) {
      throw Error(ErrorKind::bad_input, "", place,
                  "lambda " + to_text(points(i, 0)) + " is not above " + to_text(points(i - 1, 0)) +
                      " before it");
    }
  }
}

}  // namespace

Transfer low_pass(double cutoff) {
  return [cutoff](double lambda) { return lambda <= cutoff ? 1.0 : 0.0; };
}

Transfer band(double low, double high, double inside, double outside) {
  if (!(low <= high) || !std::isfinite(inside) || !std::isfinite(outside)) {
    throw bad_transfer("a band needs ends in order and finite factors");
  }
  return [=](double lambda) { return lambda >= low && lambda <= high ? inside : outside; };
}

Transfer heat(double time) {
  if (!(time >= 0.0)) throw bad_transfer("heat needs a time of at least 0");
  return [time](double lambda) { return std::exp(-lambda * time); };
}

Transfer smoothing_steps(double step, int count) {
  if (count < 0) throw bad_transfer("smoothing needs at least 0 steps");
  return [=](double lambda) { return std::pow(1.0 - step * lambda, count); };
}

Transfer piecewise_linear(const Eigen::MatrixX2d& points) {
  require_ascending(points);
  return [points](double lambda) {
    const auto lambdas = points.col(0);
    const Eigen::Index after = std::upper_bound(lambdas.begin(), lambdas.end(), lambda) -
                               lambdas.begin();  // the first point beyond
    if (after == 0) return points(0, 1);
    if (after == points.rows()) return points(after - 1, 1);
    const double share =
        (lambda - points(after - 1, 0)) / (points(after, 0) - points(after - 1, 0));
    return std::lerp(points(after - 1, 1), points(after, 1), share);
  };
}

}  // namespace timbre

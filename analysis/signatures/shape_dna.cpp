#include "timbre/analysis/signatures/shape_dna.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

double entry(double value, double i, ShapeDnaForm form) {
  switch (form) {
    case ShapeDnaForm::logarithm:
      return std::log(value + 1e-3);
    case ShapeDnaForm::per_index:
      return value / i;
    case ShapeDnaForm::weyl:
      return value / (4.0 * std::numbers::pi * i);
    case ShapeDnaForm::weighted:
      return 100.0 / (value + 5.0);
    case ShapeDnaForm::plain:
      break;
  }
  return value;
}

}  // namespace

Eigen::VectorXd compute_shape_dna(const Spectrum& spectrum, ShapeDnaForm form, int count) {
  if (count < 1) {
    throw Error(ErrorKind::bad_request, "", "count",
                "asks for " + std::to_string(count) + " eigenvalues; at least 1 is needed");
  }
  const Eigen::Index entries = std::min<Eigen::Index>(count, spectrum.values.size() - 1);
  if (entries < 1) {
    throw Error(ErrorKind::bad_request, "", "spectrum",
                "holds no eigenvalue beyond the first; at least 2 are needed");
  }
  Eigen::VectorXd dna(entries);
  for (Eigen::Index i = 1; i <= entries; ++i) {
    dna(i - 1) = entry(spectrum.values(i), static_cast<double>(i), form);
  }
  return dna;
}

}  // namespace timbre

#include "timbre/analysis/filter/closed_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

using Eigen::Index;

void require_curve(Index n) {
  if (n >= 3) return;
  throw Error(ErrorKind::bad_request, "", "curve",
              "has " + std::to_string(n) + " points; a closed curve needs 3");
}

// 2 pi share / n, exact for the whole turns that `share` may hold.
double angle(Index share, Index n) {
  return 2.0 * std::numbers::pi * static_cast<double>(share % n) / static_cast<double>(n);
}

Eigen::VectorXd eigenvector(Index n, Index i) {
  const Index frequency = (i + 1) / 2;
  const bool is_sine = i > 0 && i % 2 == 0;
  const bool is_simple = i == 0 || 2 * frequency == n;
  const double height = std::sqrt((is_simple ? 1.0 : 2.0) / static_cast<double>(n));
  Eigen::VectorXd vector(n);
  for (Index j = 0; j < n; ++j) {
    const double at = angle(frequency * j, n);
    vector[j] = height * (is_sine ? std::sin(at) : std::cos(at));
  }
  return vector;
}

}  // namespace

Operator closed_curve_operator(Index n) {
  require_curve(n);
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < n; ++i) {
    const int here = static_cast<int>(i);
    const int next = static_cast<int>((i + 1) % n);
    entries.emplace_back(here, here, 1.0);
    entries.emplace_back(here, next, -0.5);
    entries.emplace_back(next, here, -0.5);
  }
  Operator op;
  op.stiffness.resize(n, n);
  op.stiffness.setFromTriplets(entries.begin(), entries.end());
  op.mass.resize(n, n);
  op.mass.setIdentity();
  op.lumped_mass = Eigen::VectorXd::Ones(n);
  op.component.assign(static_cast<std::size_t>(n), 0);
  op.area = static_cast<double>(n);
  op.component_area = Eigen::VectorXd::Constant(1, op.area);
  op.has_constants = {true};
  op.vertices = n;
  op.kind = OperatorKind::graph;
  op.mass_kind = MassKind::uniform;
  return op;
}

Spectrum closed_curve_spectrum(Index n, Index count) {
  require_curve(n);
  if (count < 1 || count > n) {
    throw Error(ErrorKind::bad_request, "", "count",
                std::to_string(count) + " is not in the range 1 to " + std::to_string(n));
  }
  Spectrum spectrum;
  spectrum.zeros = 1;
  spectrum.values.resize(count);
  spectrum.vectors.resize(n, count);
  for (Index i = 0; i < count; ++i) {
    const double half = std::sin(0.5 * angle((i + 1) / 2, n));
    spectrum.values[i] = 2.0 * half * half;
    spectrum.vectors.col(i) = eigenvector(n, i);
  }
  const Eigen::MatrixXd errors = closed_curve_operator(n).stiffness * spectrum.vectors -
                                 spectrum.vectors * spectrum.values.asDiagonal();
  spectrum.residuals = errors.colwise().norm();
  if (count > 1) {
    spectrum.residuals.array() /= spectrum.values.array() + spectrum.values[count - 1];
  }
  const Eigen::MatrixXd gram = spectrum.vectors.transpose() * spectrum.vectors;
  spectrum.orthonormality = (gram - Eigen::MatrixXd::Identity(count, count)).cwiseAbs().maxCoeff();
  return spectrum;
}

Eigen::MatrixX2d smooth_closed_curve(Eigen::MatrixX2d points, double step, int count) {
  require_curve(points.rows());
  if (count < 0) throw Error(ErrorKind::bad_request, "", "smoothing", "needs at least 0 steps");
  const Index n = points.rows();
  Eigen::MatrixX2d before(n, 2);
  for (int turn = 0; turn < count; ++turn) {
    before.swap(points);
    for (Index i = 0; i < n; ++i) {
      const Eigen::RowVector2d middle =
          0.5 * (before.row((i + n - 1) % n) + before.row((i + 1) % n));
      points.row(i) = before.row(i) + step * (middle - before.row(i));
    }
  }
  return points;
}

Eigen::MatrixXcd to_dft(const Eigen::MatrixXd& coefficients) {
  const Index n = coefficients.rows();
  require_curve(n);
  const double size = static_cast<double>(n);
  Eigen::MatrixXcd dft(n, coefficients.cols());
  dft.row(0) = coefficients.row(0).cast<std::complex<double>>() / std::sqrt(size);
  for (Index m = 1; 2 * m < n; ++m) {
    dft.row(m).real() = coefficients.row(2 * m - 1) / std::sqrt(2.0 * size);
    dft.row(m).imag() = -coefficients.row(2 * m) / std::sqrt(2.0 * size);
    dft.row(n - m) = dft.row(m).conjugate();
  }
  if (n % 2 == 0) {
    dft.row(n / 2) = coefficients.row(n - 1).cast<std::complex<double>>() / std::sqrt(size);
  }
  return dft;
}

}  // namespace timbre

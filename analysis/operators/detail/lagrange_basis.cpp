#include "timbre/analysis/operators/detail/lagrange_basis.h"

#include <cmath>
#include <vector>

namespace timbre::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// coefficients(i, j) belongs to x^i y^j, where x and y are the first two barycentric coordinates.
using Polynomial = MatrixXd;

Polynomial product(const Polynomial& p, const Polynomial& q) {
  Polynomial result = Polynomial::Zero(p.rows() + q.rows() - 1, p.cols() + q.cols() - 1);
  for (Index i = 0; i < p.rows(); ++i) {
    for (Index j = 0; j < p.cols(); ++j) {
      result.block(i, j, q.rows(), q.cols()) += p(i, j) * q;
    }
  }
  return result;
}

// d p = dx p_x + dy p_y
Polynomial derivative(const Polynomial& p, double dx, double dy) {
  Polynomial result = Polynomial::Zero(p.rows(), p.cols());
  for (Index i = 0; i < p.rows(); ++i) {
    for (Index j = 0; j < p.cols(); ++j) {
      if (i > 0) result(i - 1, j) += dx * static_cast<double>(i) * p(i, j);
      if (j > 0) result(i, j - 1) += dy * static_cast<double>(j) * p(i, j);
    }
  }
  return result;
}

// The mean over the triangle: that of x^i y^j is 2 i! j! / (i + j + 2)!.
double mean(const Polynomial& p) {
  double sum = 0.0;
  for (Index i = 0; i < p.rows(); ++i) {
    for (Index j = 0; j < p.cols(); ++j) {
      sum += p(i, j) * 2.0 * std::tgamma(static_cast<double>(i + 1)) *
             std::tgamma(static_cast<double>(j + 1)) / std::tgamma(static_cast<double>(i + j + 3));
    }
  }
  return sum;
}

// One of the barycentric coordinates, times a factor, plus a constant.
Polynomial linear(int coordinate, double factor, double constant) {
  Polynomial p = Polynomial::Zero(2, 2);
  p(0, 0) = constant + (coordinate == 2 ? factor : 0.0);
  p(1, 0) = coordinate == 1 ? 0.0 : (coordinate == 0 ? factor : -factor);
  p(0, 1) = coordinate == 0 ? 0.0 : (coordinate == 1 ? factor : -factor);
  return p;
}

// The polynomial that is 1 at this node and 0 at all others, as a product of lines through them.
Polynomial nodal_polynomial(int degree, const Vector3d& place) {
  Polynomial p = Polynomial::Ones(1, 1);
  for (int c = 0; c < 3; ++c) {
    const int steps = static_cast<int>(std::lround(degree * place[c]));
    for (int s = 0; s < steps; ++s) {
      p = product(
          p, linear(c, static_cast<double>(degree) / (s + 1), -static_cast<double>(s) / (s + 1)));
    }
  }
  return p;
}

std::vector<Polynomial> nodal_polynomials(int degree) {
  std::vector<Polynomial> basis;
  const Eigen::Matrix<double, Eigen::Dynamic, 3> places = lagrange_places(degree);
  for (Index i = 0; i < places.rows(); ++i) {
    basis.push_back(nodal_polynomial(degree, places.row(i).transpose()));
  }
  return basis;
}

double value(const Polynomial& p, double x, double y) {
  double sum = 0.0;
  for (Index i = p.rows() - 1; i >= 0; --i) {
    double inner = 0.0;
    for (Index j = p.cols() - 1; j >= 0; --j) inner = inner * y + p(i, j);
    sum = sum * x + inner;
  }
  return sum;
}

MatrixXd mean_products(const std::vector<Polynomial>& p) {
  const auto n = static_cast<Index>(p.size());
  MatrixXd means(n, n);
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j <= i; ++j) {
      means(i, j) = means(j, i) =
          mean(product(p[static_cast<std::size_t>(i)], p[static_cast<std::size_t>(j)]));
    }
  }
  return means;
}

}  // namespace

Eigen::Matrix<double, Eigen::Dynamic, 3> lagrange_places(int degree) {
  const int centres = degree == 3 ? 1 : 0;
  Eigen::Matrix<double, Eigen::Dynamic, 3> places =
      Eigen::Matrix<double, Eigen::Dynamic, 3>::Zero(3 * degree + centres, 3);
  places.topRows(3).setIdentity();
  Index row = 3;
  for (int side = 0; side < 3; ++side) {
    for (int step = 1; step < degree; ++step, ++row) {
      const double share = static_cast<double>(step) / degree;
      places(row, (side + 1) % 3) = 1.0 - share;
      places(row, (side + 2) % 3) = share;
    }
  }
  if (centres > 0) places.row(row).setConstant(1.0 / 3.0);
  return places;
}

VectorXd lagrange_values(int degree, const Vector3d& corner) {
  const std::vector<Polynomial> basis = nodal_polynomials(degree);
  VectorXd values(static_cast<Index>(basis.size()));
  for (Index i = 0; i < values.size(); ++i) {
    values[i] = value(basis[static_cast<std::size_t>(i)], corner[0], corner[1]);
  }
  return values;
}

// With D_c the derivative along the side opposite corner c, from one end of it to the other as
// the barycentric coordinates count, grad u . grad v = sum_c cot_c / (2 A) D_c u D_c v.
ReferenceElement reference_element(int degree) {
  const std::vector<Polynomial> basis = nodal_polynomials(degree);
  ReferenceElement element;
  element.mass = mean_products(basis);
  constexpr std::array<std::array<double, 2>, 3> kAlong = {{{0.0, 1.0}, {1.0, 0.0}, {1.0, -1.0}}};
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<Polynomial> slopes;
    slopes.reserve(basis.size());
    for (const Polynomial& p : basis) slopes.push_back(derivative(p, kAlong[c][0], kAlong[c][1]));
    element.stiffness[c] = 0.5 * mean_products(slopes);
  }
  return element;
}

}  // namespace timbre::detail

#include "timbre/analysis/operators/detail/lagrange_basis.h"

#include <gtest/gtest.h>

namespace timbre::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;

class EveryBasis : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Degrees, EveryBasis, testing::Values(1, 2, 3));

TEST_P(EveryBasis, IsOneAtItsNodeAndZeroAtTheOthers) {
  const auto places = lagrange_places(GetParam());
  MatrixXd values(places.rows(), places.rows());
  for (Index i = 0; i < places.rows(); ++i) {
    values.row(i) = lagrange_values(GetParam(), places.row(i).transpose());
    EXPECT_NEAR(places.row(i).sum(), 1.0, 1e-15);
  }
  EXPECT_LT((values - MatrixXd::Identity(values.rows(), values.cols())).cwiseAbs().maxCoeff(),
            1e-14);
}

TEST_P(EveryBasis, IntegratesOneToTheArea) {
  const ReferenceElement element = reference_element(GetParam());
  EXPECT_NEAR(element.mass.sum(), 1.0, 1e-14);
  for (const MatrixXd& stiffness : element.stiffness) {
    EXPECT_LT(stiffness.rowwise().sum().cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT((stiffness - stiffness.transpose()).cwiseAbs().maxCoeff(), 1e-14);
  }
}

// On the right triangle of sides 1 the cotangents are 0, 1, 1: x^p has known integrals there.
TEST_P(EveryBasis, IntegratesPowersExactly) {
  const int degree = GetParam();
  const ReferenceElement element = reference_element(degree);
  const auto places = lagrange_places(degree);
  const Eigen::VectorXd u = places.col(1).array().pow(degree);  // x^p
  const MatrixXd stiffness = element.stiffness[1] + element.stiffness[2];
  const double p = degree;
  // Of x^q over the triangle: 1 / ((q + 1) (q + 2)).
  EXPECT_NEAR(u.dot(stiffness * u), p * p / ((2 * p - 1) * (2 * p)), 1e-14);
  EXPECT_NEAR(0.5 * u.dot(element.mass * u), 1.0 / ((2 * p + 1) * (2 * p + 2)), 1e-15);
}

}  // namespace
}  // namespace timbre::detail

#include "timbre/analysis/spectrum/detail/shifted_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/refused_request.h"

namespace timbre::detail {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class EveryFactor : public testing::TestWithParam<FactorizationBackend> {
 protected:
  void SetUp() override {
    if (GetParam() == FactorizationBackend::cholmod && !has_cholmod()) {
      GTEST_SKIP() << "built without CHOLMOD";
    }
  }
};

Operator small_operator(MassKind mass) {
  return compute_operator(make_ellipsoid(1.0, 1.3, 1.9, 5), {.mass = mass});
}

TEST_P(EveryFactor, CountsTheEigenvaluesBelowAnyShift) {
  for (const MassKind mass : {MassKind::lumped, MassKind::consistent}) {
    const Operator op = small_operator(mass);
    const VectorXd values = Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(
                                MatrixXd(op.stiffness), MatrixXd(op.mass))
                                .eigenvalues();
    const auto factor = make_shifted_factor(op.stiffness, op.mass, nullptr, GetParam());
    EXPECT_EQ(factor->factorize(-1.0).negative, 0);
    for (Eigen::Index i = 1; i < 60; i += 3) {
      if (values[i] - values[i - 1] < 1e-6) continue;
      const LdltReport report = factor->factorize(0.5 * (values[i] + values[i - 1]));
      EXPECT_FALSE(report.near_singular);
      EXPECT_EQ(report.negative, i);
    }
  }
}

TEST_P(EveryFactor, SolvesWithAsManyRightHandSidesAsAllowed) {
  const Operator op = small_operator(MassKind::consistent);
  const auto factor = make_shifted_factor(op.stiffness, op.mass, nullptr, GetParam());
  constexpr double kShift = 30.0;
  ASSERT_FALSE(factor->factorize(kShift).near_singular);
  const auto n = static_cast<Eigen::Index>(factor->order().size());
  for (const int width : {8, 16, 32}) {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Rows B = Rows::Random(n, width);
    Rows X = B;
    factor->solve_in_factor_order(X.data(), width);
    Rows product(n, width);
    multiply(factor->pencil(), kShift, X.data(), width, product.data());
    EXPECT_LT((product - B).norm(), 1e-10 * B.norm());
  }
}

TEST_P(EveryFactor, DoubtsACountAtAnEigenvalue) {
  const Operator op = small_operator(MassKind::lumped);
  const auto factor = make_shifted_factor(op.stiffness, op.mass, nullptr, GetParam());
  EXPECT_TRUE(factor->factorize(0.0).near_singular);  // the constants
  EXPECT_FALSE(factor->factorize(0.1).near_singular);
}

INSTANTIATE_TEST_SUITE_P(Backends, EveryFactor,
                         testing::Values(FactorizationBackend::supernodal,
                                         FactorizationBackend::cholmod,
                                         FactorizationBackend::eigen));

TEST(MakeShiftedFactor, RefusesABackendThatIsNotThere) {
  if (has_cholmod()) GTEST_SKIP() << "built with CHOLMOD";
  const Operator op = small_operator(MassKind::lumped);
  const std::string refusal = refused_request([&] {
    (void)make_shifted_factor(op.stiffness, op.mass, nullptr, FactorizationBackend::cholmod);
  });
  EXPECT_NE(refusal.find("no CHOLMOD"), std::string::npos);
}

}  // namespace
}  // namespace timbre::detail

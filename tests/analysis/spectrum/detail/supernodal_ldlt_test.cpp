#include "timbre/analysis/spectrum/detail/supernodal_ldlt.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/detail/panels.h"
#include "timbre/analysis/spectrum/detail/solve_plan.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/refused_request.h"
#include "timbre/tests/support/sparse_matrices.h"

namespace timbre::detail {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

SparseMatrix no_entries(const SparseMatrix& K) { return {K.rows(), K.cols()}; }

MatrixXd full(const SparseMatrix& lower) { return MatrixXd(lower).selfadjointView<Eigen::Lower>(); }

MatrixXd random_block(Eigen::Index rows, Eigen::Index cols) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  MatrixXd X(rows, cols);
  for (double& x : X.reshaped()) x = uniform(random);
  return X;
}

// |A x - b| / (|A| |x| + |b|) of the worst column.
double backward_error(const MatrixXd& A, const MatrixXd& X, const MatrixXd& B) {
  double worst = 0.0;
  if (A.size() == 0) return 0.0;
  const double norm = A.cwiseAbs().rowwise().sum().maxCoeff();
  for (Eigen::Index c = 0; c < X.cols(); ++c) {
    const double error = (A * X.col(c) - B.col(c)).norm();
    worst = std::max(worst, error / (norm * X.col(c).norm() + B.col(c).norm()));
  }
  return worst;
}

std::int64_t negative_eigenvalues(const MatrixXd& A) {
  if (A.rows() == 0) return 0;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(A, Eigen::EigenvaluesOnly);
  return (solver.eigenvalues().array() < 0.0).count();
}

class EveryPattern : public testing::TestWithParam<NamedMatrix> {};

TEST_P(EveryPattern, DefiniteMatricesAreSolvedToRounding) {
  const SparseMatrix K = made_definite(GetParam().matrix);
  SupernodalLdlt ldlt(K, no_entries(K));
  const LdltReport report = ldlt.factorize(0.0);
  EXPECT_EQ(report.negative, 0);
  EXPECT_FALSE(report.near_singular);
  EXPECT_LT(report.backward_error, 1e-14);
  const MatrixXd B = random_block(K.rows(), 3);
  MatrixXd X = B;
  ldlt.solve(X);
  EXPECT_LT(backward_error(full(K), X, B), 1e-14);
}

// Random matrices are what pivoting inside panels is not made for: then it must say so.
TEST_P(EveryPattern, IndefiniteMatricesAreCountedOrReported) {
  const SparseMatrix& K = GetParam().matrix;
  for (const OrderingMethod ordering :
       {OrderingMethod::minimum_degree, OrderingMethod::natural, OrderingMethod::metis}) {
    if (ordering == OrderingMethod::metis && !has_metis()) continue;
    SupernodalLdlt ldlt(K, no_entries(K), nullptr, {.ordering = ordering});
    const LdltReport report = ldlt.factorize(0.0);
    if (report.near_singular) continue;
    EXPECT_EQ(report.negative, negative_eigenvalues(full(K)));
    EXPECT_LT(report.residual, 1e-2);
  }
}

TEST_P(EveryPattern, ShiftsAwayFromTheSpectrumAreCountedAndSolved) {
  const SparseMatrix K = made_definite(GetParam().matrix);
  const SparseMatrix M = identity(K.rows());
  SupernodalLdlt ldlt(K, M);
  if (K.rows() == 0) return;
  const VectorXd values = Eigen::SelfAdjointEigenSolver<MatrixXd>(full(K)).eigenvalues();
  const MatrixXd B = random_block(K.rows(), 9);
  for (const double share : {0.02, 0.3, 0.7, 1.0}) {
    const auto below = static_cast<Eigen::Index>(share * static_cast<double>(K.rows() - 1));
    const double next = below + 1 < K.rows() ? values[below + 1] : values[below] + 1.0;
    if (next - values[below] < 1e-6 * next) continue;
    const double shift = 0.5 * (values[below] + next);
    const LdltReport report = ldlt.factorize(shift);
    if (report.near_singular) continue;
    EXPECT_EQ(report.negative, below + 1) << "shift " << shift;
    MatrixXd X = B;
    ldlt.solve(X);
    const MatrixXd A = full(K) - shift * MatrixXd::Identity(K.rows(), K.rows());
    EXPECT_LT(backward_error(A, X, B), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Patterns, EveryPattern, testing::ValuesIn(matrices_of_many_patterns()),
                         [](const auto& test) { return test.param.name; });

// Most random matrices with a full diagonal need no more than pivoting inside panels.
TEST(SupernodalLdlt, ReportsFewOfTheRandomMatrices) {
  int reported = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const SparseMatrix K = random_sparse(40 + static_cast<int>(seed), 4.0, seed);
    SupernodalLdlt ldlt(K, no_entries(K));
    const LdltReport report = ldlt.factorize(0.0);
    reported += report.near_singular ? 1 : 0;
    if (!report.near_singular) {
      EXPECT_EQ(report.negative, negative_eigenvalues(full(K))) << "seed " << seed;
    }
  }
  EXPECT_LE(reported, 3);
}

TEST(SupernodalLdlt, SaddlePointsWithoutDiagonalAreReportedWhereTheyFail) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const SparseMatrix K = saddle_point(30, 12, seed);
    for (const OrderingMethod ordering :
         {OrderingMethod::natural, OrderingMethod::minimum_degree}) {
      SupernodalLdlt ldlt(K, no_entries(K), nullptr, {.ordering = ordering});
      const LdltReport report = ldlt.factorize(0.0);
      if (report.near_singular) continue;
      EXPECT_EQ(report.negative, negative_eigenvalues(full(K)));
    }
  }
}

TEST(SupernodalLdlt, ChoosesTwoByTwoPivotsWhereTheDiagonalIsZero) {
  SparseMatrix K(2, 2);
  K.insert(1, 0) = 3.0;
  SupernodalLdlt ldlt(K, no_entries(K));
  const LdltReport report = ldlt.factorize(0.0);
  EXPECT_EQ(report.two_by_two, 1);
  EXPECT_EQ(report.negative, 1);
  EXPECT_FALSE(report.near_singular);
  MatrixXd X(2, 1);
  X << 6.0, 3.0;
  ldlt.solve(X);
  EXPECT_EQ(X(0, 0), 1.0);
  EXPECT_EQ(X(1, 0), 2.0);
}

TEST(SupernodalLdlt, ReportsSingularMatrices) {
  const Operator op = compute_operator(make_sphere(8));
  SupernodalLdlt ldlt(op.stiffness, op.mass);
  EXPECT_TRUE(ldlt.factorize(0.0).near_singular);
  EXPECT_FALSE(ldlt.factorize(-1e-3).near_singular);
  SparseMatrix zero(3, 3);
  SupernodalLdlt nothing(zero, zero);
  const LdltReport report = nothing.factorize(1.0);
  EXPECT_TRUE(report.near_singular);
  EXPECT_EQ(report.replaced, 3);
}

// The flat torus has its discrete spectrum in closed form, with multiplicities 4 and 8. Parts cut
// out along nodal lines have the same eigenvalue, so that pivots inside them vanish too.
TEST(SupernodalLdlt, CountsOnBothSidesOfAnEigenvalueOrReportsIt) {
  constexpr int kSide = 24;
  const IntrinsicMesh torus = make_flat_torus(kSide);
  const Operator op = compute_operator(torus.faces, torus.lengths, torus.vertices);
  const auto part = [](int i) { return 2.0 - 2.0 * std::cos(2.0 * std::numbers::pi * i / kSide); };
  const double exact = kSide * kSide * (part(3) + part(2));
  std::int64_t below = 0;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      below += kSide * kSide * (part(i) + part(j)) < exact * (1.0 - 1e-9) ? 1 : 0;
    }
  }
  SupernodalLdlt ldlt(op.stiffness, op.mass);
  for (const double distance : {-1e-3, -1e-5, 1e-5, 1e-3}) {
    const LdltReport report = ldlt.factorize(exact * (1.0 + distance));
    EXPECT_FALSE(report.near_singular) << distance;
    EXPECT_EQ(report.negative, below + (distance < 0.0 ? 0 : 8)) << distance;
    EXPECT_LT(report.backward_error, 1e-11) << distance;
  }
  for (const double sign : {-1.0, 1.0}) {
    for (double distance = 1e-6; distance > 1e-16; distance *= 0.5) {
      const LdltReport report = ldlt.factorize(exact * (1.0 + sign * distance));
      if (report.near_singular) continue;
      EXPECT_EQ(report.negative, below + (sign < 0.0 ? 0 : 8)) << sign * distance;
    }
  }
  EXPECT_TRUE(ldlt.factorize(exact).near_singular);
}

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

std::vector<NamedMesh> meshes() {
  return {{"sphere", make_sphere(20)},
          {"ellipsoid", make_ellipsoid(1.0, 0.3, 5.0, 15)},
          {"torus", make_torus(3.0, 1.0, 60, 30)},
          {"rectangle", make_rectangle(1.0, 0.1, 80, 20)},
          {"disk", make_disk(25)}};
}

class EveryMesh : public testing::TestWithParam<NamedMesh> {};

TEST_P(EveryMesh, AgreesWithEigenOnBothMassesAndEveryOrdering) {
  const TriangleMesh& mesh = GetParam().mesh;
  for (const MassKind kind : {MassKind::lumped, MassKind::consistent}) {
    const Operator op = compute_operator(mesh, {.mass = kind});
    for (const OrderingMethod ordering :
         {OrderingMethod::geometric, OrderingMethod::metis, OrderingMethod::minimum_degree}) {
      if (ordering == OrderingMethod::metis && !has_metis()) continue;
      SupernodalLdlt ldlt(op.stiffness, op.mass, &mesh.vertices, {.ordering = ordering});
      for (const double shift : {-1.0, 17.3, 400.7}) {
        const SparseMatrix A = op.stiffness - shift * op.mass;
        const Eigen::SimplicialLDLT<SparseMatrix> peer(A);
        const LdltReport report = ldlt.factorize(shift);
        EXPECT_FALSE(report.near_singular);
        EXPECT_EQ(report.negative, (peer.vectorD().array() < 0.0).count());
        EXPECT_LT(report.backward_error, 1e-10);
        const MatrixXd B = random_block(A.rows(), 2);
        MatrixXd X = B;
        ldlt.solve(X);
        const MatrixXd expected = peer.solve(B);
        EXPECT_LT((X - expected).norm(), 1e-8 * expected.norm());
      }
    }
  }
}

TEST_P(EveryMesh, SolvesAnyNumberOfRightHandSidesAlike) {
  const Operator op = compute_operator(GetParam().mesh);
  SupernodalLdlt ldlt(op.stiffness, op.mass);
  ldlt.factorize(33.3);
  const MatrixXd B = random_block(op.stiffness.rows(), 64);
  MatrixXd all = B;
  ldlt.solve(all);
  for (const Eigen::Index count : {1, 7, 8, 9, 16, 17, 31, 33, 41, 63}) {
    MatrixXd some = B.leftCols(count);
    ldlt.solve(some);
    EXPECT_LT((some - all.leftCols(count)).norm(), 1e-9 * all.norm()) << count;
  }
}

TEST_P(EveryMesh, TheFactorDoesNotDependOnThreads) {
  const Operator op = compute_operator(GetParam().mesh);
  const MatrixXd B = random_block(op.stiffness.rows(), 5);
  SupernodalLdlt one(op.stiffness, op.mass, &GetParam().mesh.vertices);
  one.factorize(55.5);
  MatrixXd expected = B;
  one.solve(expected);
  for (const int threads : {2, 3, 8}) {
    SupernodalLdlt many(op.stiffness, op.mass, &GetParam().mesh.vertices, {.threads = threads});
    many.factorize(55.5);
    many.factorize(55.5);  // again, over what is there
    MatrixXd X = B;
    many.solve(X);
    EXPECT_EQ(X, expected) << threads;
  }
}

TEST_P(EveryMesh, InstructionSetsAgreeToRounding) {
  const Operator op = compute_operator(GetParam().mesh);
  const MatrixXd B = random_block(op.stiffness.rows(), 32);
  SupernodalLdlt portable(op.stiffness, op.mass, nullptr,
                          {.instructions = InstructionSet::portable});
  const LdltReport expected = portable.factorize(99.1);
  MatrixXd Y = B;
  portable.solve(Y);
  for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
    if (!has(set)) continue;
    SupernodalLdlt ldlt(op.stiffness, op.mass, nullptr, {.instructions = set});
    EXPECT_EQ(ldlt.factorize(99.1).negative, expected.negative);
    for (const Eigen::Index count : {8, 16, 32}) {
      MatrixXd X = B.leftCols(count);
      ldlt.solve(X);
      EXPECT_LT((X - Y.leftCols(count)).norm(), 1e-9 * Y.norm());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, EveryMesh, testing::ValuesIn(meshes()),
                         [](const auto& test) { return test.param.name; });

// Two surfaces in one operator, far apart and on top of each other.
TEST(SupernodalLdlt, TakesSeveralComponentsWhereverTheyAre) {
  const TriangleMesh sphere = make_sphere(6);
  const Operator one = compute_operator(sphere);
  SupernodalLdlt single(one.stiffness, one.mass);
  const std::int64_t expected = single.factorize(8.5).negative;
  for (const double offset : {0.0, 10.0}) {
    TriangleMesh twice = sphere;
    const Eigen::Index n = sphere.vertices.rows();
    twice.vertices.conservativeResize(2 * n, 3);
    twice.vertices.bottomRows(n) = sphere.vertices.array() + offset;
    twice.faces.conservativeResize(2 * sphere.faces.rows(), 3);
    twice.faces.bottomRows(sphere.faces.rows()) =
        sphere.faces.array() + static_cast<std::int32_t>(n);
    const Operator op = compute_operator(twice);
    SupernodalLdlt ldlt(op.stiffness, op.mass, &twice.vertices,
                        {.ordering = OrderingMethod::geometric});
    EXPECT_EQ(ldlt.factorize(8.5).negative, 2 * expected) << offset;
  }
}

TEST(SupernodalLdlt, FactorOrderSkipsThePermutation) {
  const Operator op = compute_operator(make_sphere(10));
  SupernodalLdlt ldlt(op.stiffness, op.mass);
  ldlt.factorize(5.0);
  const MatrixXd B = random_block(op.stiffness.rows(), 8);
  MatrixXd expected = B;
  ldlt.solve(expected);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> X =
      B(ldlt.symbolic().order, Eigen::all);
  ldlt.solve_in_factor_order(X.data(), 8);
  EXPECT_EQ(MatrixXd(X), MatrixXd(expected(ldlt.symbolic().order, Eigen::all)));
}

// Large enough for subtrees that are solved at the same time.
TEST(SupernodalLdlt, SolvesOfLargeFactorsDoNotDependOnThreads) {
  const TriangleMesh mesh = make_sphere(40);
  const Operator op = compute_operator(mesh);
  const MatrixXd B = random_block(op.stiffness.rows(), 56);  // all widths of a pass
  MatrixXd expected;
  for (const int threads : {1, 2, 3, 8}) {
    SupernodalLdlt ldlt(op.stiffness, op.mass, &mesh.vertices, {.threads = threads});
    EXPECT_LT(ldlt.factorize(50.0).backward_error, 1e-13);
    MatrixXd X = B;
    ldlt.solve(X);
    if (threads == 1) expected = X;
    EXPECT_EQ(X, expected) << threads;
  }
}

TEST(PlanSolves, PutsEachSupernodeInOnePart) {
  const TriangleMesh mesh = make_sphere(40);
  const Operator op = compute_operator(mesh);
  const Pencil pencil = make_pencil(op.stiffness, op.mass);
  const SymbolicFactor symbolic = analyse(
      pencil, compute_ordering(adjacency(pencil), &mesh.vertices, OrderingMethod::geometric));
  const SolvePlan plan = plan_solves(symbolic, lay_out_panels(symbolic));
  ASSERT_GE(plan.subtrees(), 2);
  std::vector<int> part(static_cast<std::size_t>(symbolic.supernodes()), -2);
  for (int q = 0; q < plan.subtrees(); ++q) {
    for (int s = plan.first[q]; s <= plan.root[q]; ++s) part[s] = q;
    EXPECT_EQ(plan.handed[q + 1] - plan.handed[q], symbolic.rows_below(plan.root[q]));
  }
  for (const int s : plan.top) {
    EXPECT_EQ(part[s], -2);
    part[s] = -1;
  }
  for (int s = 0; s < symbolic.supernodes(); ++s) {
    ASSERT_NE(part[s], -2);
    if (symbolic.parent[s] == -1) continue;
    const int of_parent = part[symbolic.parent[s]];
    EXPECT_TRUE(of_parent == part[s] || of_parent == -1);
  }
}

TEST(SupernodalLdlt, SaysHowMuchMemoryItWillTake) {
  const Operator op = compute_operator(make_sphere(30));
  const SupernodalLdlt ldlt(op.stiffness, op.mass);
  EXPECT_GT(ldlt.bytes(), 8 * ldlt.symbolic().entries);
  EXPECT_LT(ldlt.bytes(), 4 * 8 * ldlt.symbolic().entries);
}

TEST(SupernodalLdlt, ReportsWhatIsNotANumber) {
  SparseMatrix K = made_definite(random_sparse(30, 3.0, 1));
  K.coeffRef(7, 7) = std::numeric_limits<double>::quiet_NaN();
  SupernodalLdlt ldlt(K, no_entries(K));
  EXPECT_TRUE(ldlt.factorize(0.0).near_singular);
}

TEST(SupernodalLdlt, RefusesWhatCannotBeSolvedAndSaysSo) {
  const SparseMatrix K = made_definite(random_sparse(10, 3.0, 1));
  SupernodalLdlt ldlt(K, no_entries(K));
  MatrixXd X = random_block(10, 1);
  EXPECT_EQ(refused_request([&] { ldlt.solve(X); }), "solve: nothing is factorised yet");
  ldlt.factorize(0.0);
  MatrixXd short_one = random_block(9, 1);
  EXPECT_EQ(refused_request([&] { ldlt.solve(short_one); }),
            "solve: right-hand sides have 9 rows, the matrix has 10");
  EXPECT_EQ(refused_request([&] { SupernodalLdlt(K, SparseMatrix(9, 9)); }),
            "pencil: matrices of 10 x 10 and 9 x 9; both must be square and of the same size");
}

TEST(SupernodalLdlt, StopsWhereItIsToldAndStartsAgain) {
  const Operator op = compute_operator(make_ellipsoid(1.0, 1.3, 1.9, 16));
  constexpr double kShift = 30.0;
  const auto negative = SupernodalLdlt(op.stiffness, op.mass, nullptr).factorize(kShift).negative;
  for (const int threads : {1, 3}) {
    bool is_told = true;
    int calls = 0;
    const auto between = [&] {
      ++calls;
      if (is_told) throw std::string("stop");
    };
    SupernodalLdlt ldlt(op.stiffness, op.mass, nullptr, {.threads = threads, .between = between});
    EXPECT_THROW((void)ldlt.factorize(kShift), std::string);
    EXPECT_EQ(calls, 1);
    MatrixXd X = MatrixXd::Ones(op.mass.rows(), 1);
    EXPECT_EQ(refused_request([&] { ldlt.solve(X); }), "solve: nothing is factorised yet");
    is_told = false;
    EXPECT_EQ(ldlt.factorize(kShift).negative, negative);
    EXPECT_GT(calls, 2);
  }
}

}  // namespace
}  // namespace timbre::detail

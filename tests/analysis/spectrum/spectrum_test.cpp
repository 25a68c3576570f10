#include "timbre/analysis/spectrum/spectrum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/mesh_shapes.h"

namespace timbre {
namespace {

constexpr double kPi = std::numbers::pi;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd spectrum_values(const TriangleMesh& mesh, int count, MassKind mass = MassKind::lumped) {
  return compute_spectrum(compute_operator(mesh, {.mass = mass}), {.count = count}).values;
}

// Order of convergence in h between two meshes, h halved.
double order(double coarse_error, double fine_error) {
  return std::log2(coarse_error / fine_error);
}

TEST(ComputeSpectrum, ConvergesOnTheSphereWithOrderTwo) {
  const double exact = 12.0;  // l = 3: pairs 9 to 15
  for (const MassKind mass : {MassKind::lumped, MassKind::consistent}) {
    const auto error = [&](int frequency) {
      return std::abs(spectrum_values(make_sphere(frequency), 16, mass).segment(9, 7).mean() -
                      exact);
    };
    EXPECT_NEAR(order(error(8), error(16)), 2.0, 0.1) << to_word(mass);
  }
}

TEST(ComputeSpectrum, FindsTheClustersOfTheSphere) {
  const VectorXd values = spectrum_values(make_sphere(20), 49);
  for (int l = 0, i = 0; l < 7; ++l) {
    for (int m = 0; m < 2 * l + 1; ++m, ++i)
      EXPECT_NEAR(values[i], l * (l + 1), 0.02 * l * (l + 1));
  }
}

TEST(ComputeSpectrum, ConvergesOnTheRectangleWithOrderTwo) {
  const double exact = kPi * kPi;  // width 1, height 2: (1, 0) comes second to (0, 1), (0, 2)
  const auto error = [&](int n) {
    const VectorXd values = spectrum_values(make_rectangle(1.0, 2.0, n, 2 * n), 4);
    EXPECT_NEAR(values[1], kPi * kPi / 4.0, 0.05);
    return std::abs(0.5 * (values[2] + values[3]) - exact);
  };
  EXPECT_NEAR(order(error(8), error(16)), 2.0, 0.15);
}

TEST(ComputeSpectrum, ConvergesOnTheDiskWithOrderTwo) {
  const double exact = 3.3899577;  // square of the first zero of J_1', twice
  const auto error = [&](int rings) {
    return std::abs(spectrum_values(make_disk(rings), 3).tail(2).mean() - exact);
  };
  EXPECT_NEAR(order(error(8), error(16)), 2.0, 0.2);
}

TEST(ComputeSpectrum, IsExactOnTheFlatTorusGrid) {
  const int n = 24;
  const IntrinsicMesh torus = make_flat_torus(n);
  const Operator op = compute_operator(torus.faces, torus.lengths, torus.vertices);
  std::vector<double> exact;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      exact.push_back(
          n * n * (4.0 - 2.0 * std::cos(2.0 * kPi * i / n) - 2.0 * std::cos(2.0 * kPi * j / n)));
    }
  }
  std::sort(exact.begin(), exact.end());
  for (const int count : {20, 21, 23, 60}) {  // 21 and 23 end inside clusters
    const Spectrum found = compute_spectrum(op, {.count = count});
    for (int i = 0; i < count; ++i) {
      EXPECT_NEAR(found.values[i], exact[static_cast<std::size_t>(i)], 1e-8) << count << ' ' << i;
    }
    ASSERT_TRUE(found.certificate);
    EXPECT_GE(found.certificate->count, count);
    EXPECT_EQ(found.certificate->count, std::count_if(exact.begin(), exact.end(), [&](double x) {
                return x < found.certificate->bound;
              }));
  }
}

class EveryBackend : public testing::TestWithParam<std::tuple<FactorizationBackend, MassKind>> {
 protected:
  void SetUp() override {
    if (std::get<0>(GetParam()) == FactorizationBackend::cholmod && !has_cholmod()) {
      GTEST_SKIP() << "built without CHOLMOD";
    }
  }
};

TEST_P(EveryBackend, ReturnsOrthonormalPairsThatSolveTheEquation) {
  const auto [backend, mass] = GetParam();
  const Operator op = compute_operator(make_ellipsoid(1.0, 1.3, 1.9, 10), {.mass = mass});
  const Spectrum found = compute_spectrum(op, {.count = 40, .backend = backend});
  const MatrixXd MV = op.mass * found.vectors;
  EXPECT_LT((found.vectors.transpose() * MV - MatrixXd::Identity(40, 40)).cwiseAbs().maxCoeff(),
            1e-9);
  EXPECT_LT((op.stiffness * found.vectors - MV * found.values.asDiagonal()).norm(), 1e-7);
  EXPECT_LE(found.residuals.maxCoeff(), 1e-6);
  EXPECT_LE(found.orthonormality, 1e-8);
  EXPECT_EQ(found.zeros, 1);
  EXPECT_EQ(found.values[0], 0.0);
}

TEST_P(EveryBackend, AgreesWithTheDenseSolver) {
  const auto [backend, mass] = GetParam();
  const Operator op = compute_operator(make_ellipsoid(1.0, 1.3, 1.9, 8), {.mass = mass});
  const Spectrum sparse = compute_spectrum(op, {.count = 30, .backend = backend});
  const Spectrum dense = compute_spectrum(op, {.count = 500, .backend = backend});  // over n / 4
  EXPECT_LT((sparse.values - dense.values.head(30)).cwiseAbs().maxCoeff(), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Backends, EveryBackend,
                         testing::Combine(testing::Values(FactorizationBackend::supernodal,
                                                          FactorizationBackend::eigen,
                                                          FactorizationBackend::cholmod),
                                          testing::Values(MassKind::lumped, MassKind::consistent)));

TriangleMesh copies(const TriangleMesh& one, const std::vector<double>& scales) {
  TriangleMesh all;
  const Eigen::Index n = one.vertices.rows();
  const Eigen::Index m = one.faces.rows();
  const auto count = static_cast<Eigen::Index>(scales.size());
  all.vertices.resize(n * count, 3);
  all.faces.resize(m * count, 3);
  for (Eigen::Index c = 0; c < count; ++c) {
    all.vertices.middleRows(c * n, n) = scales[static_cast<std::size_t>(c)] * one.vertices;
    all.faces.middleRows(c * m, m) = one.faces.array() + static_cast<std::int32_t>(c * n);
  }
  return all;
}

TEST(ComputeSpectrum, MergesComponentsAndCountsTheirZeros) {
  const TriangleMesh one = make_sphere(6);
  const VectorXd single = spectrum_values(one, 30);
  const Spectrum found =
      compute_spectrum(compute_operator(copies(one, {1.0, 1.0, 1.0, 1.0})), {.count = 100});
  EXPECT_EQ(found.zeros, 4);
  for (int i = 0; i < 100; ++i) EXPECT_NEAR(found.values[i], single[i / 4], 1e-8) << i;
  ASSERT_TRUE(found.certificate);
  EXPECT_GE(found.certificate->count, 100);
}

TEST(ComputeSpectrum, ATinyComponentBringsItsZeroAndNothingElse) {
  const TriangleMesh one = make_sphere(6);
  const VectorXd single = spectrum_values(one, 20);
  const VectorXd both =
      compute_spectrum(compute_operator(copies(one, {1.0, 1e-6})), {.count = 21}).values;
  EXPECT_EQ(both[0], 0.0);
  EXPECT_EQ(both[1], 0.0);
  EXPECT_LT((both.tail(19) - single.tail(19)).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(ComputeSpectrum, KeepsUnusedVerticesAtZero) {
  TriangleMesh mesh = make_sphere(4);
  const VectorXd before = spectrum_values(mesh, 12);
  mesh.vertices.conservativeResize(mesh.vertices.rows() + 2, 3);
  mesh.vertices.bottomRows(2).setConstant(5.0);
  const Spectrum after = compute_spectrum(compute_operator(mesh), {.count = 12});
  EXPECT_LT((after.values - before).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(after.vectors.bottomRows(2).cwiseAbs().maxCoeff(), 0.0);
}

TEST(ComputeSpectrum, ScalesLikeOneOverLengthSquared) {
  TriangleMesh mesh = make_sphere(6);
  const VectorXd unit = spectrum_values(mesh, 20);
  mesh.vertices *= 1000.0;
  EXPECT_LT((spectrum_values(mesh, 20) * 1e6 - unit).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(ComputeSpectrum, DoesNotDependOnTheOrderOfVertices) {
  const TriangleMesh mesh = make_ellipsoid(1.0, 1.2, 1.7, 10);
  std::vector<std::int32_t> order(static_cast<std::size_t>(mesh.vertices.rows()));
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  TriangleMesh shuffled = mesh;
  for (std::size_t i = 0; i < order.size(); ++i) {
    shuffled.vertices.row(order[i]) = mesh.vertices.row(static_cast<Eigen::Index>(i));
  }
  for (std::int32_t& corner : shuffled.faces.reshaped()) {
    corner = order[static_cast<std::size_t>(corner)];
  }
  EXPECT_LT((spectrum_values(shuffled, 50) - spectrum_values(mesh, 50)).cwiseAbs().maxCoeff(),
            1e-9);
}

TEST(ComputeSpectrum, GivesEveryPairWhenAskedForMoreThanThereAre) {
  const VectorXd values = spectrum_values(make_rectangle(1.0, 1.0, 1, 1), 50);
  EXPECT_EQ(values.size(), 4);
}

TEST(ComputeSpectrum, CertifiesSmallSymmetricMeshesForEveryCount) {
  const TriangleMesh triangle = make_mesh({{1, 0, 0}, {0, 1, 0}, {0, 0, 0}}, {{0, 1, 2}});
  for (const TriangleMesh& mesh : {octahedron(), triangle}) {
    for (int count = 1; count <= 6; ++count) {
      for (const auto backend : {FactorizationBackend::eigen, FactorizationBackend::automatic}) {
        const Spectrum found =
            compute_spectrum(compute_operator(mesh), {.count = count, .backend = backend});
        ASSERT_TRUE(found.certificate);
        EXPECT_GE(found.certificate->count, found.values.size());
      }
    }
  }
}

TEST(ComputeSpectrum, FindsWhatOneStartVectorCannotSee) {
  // Every eigenvalue fourfold and more: one Krylov space holds one copy of each in exact
  // arithmetic, the others by rounding or by deflation.
  const IntrinsicMesh torus = make_flat_torus(40);
  const Operator op = compute_operator(torus.faces, torus.lengths, torus.vertices);
  const Spectrum found = compute_spectrum(op, {.count = 150});
  ASSERT_TRUE(found.certificate);
  EXPECT_LE(found.orthonormality, 1e-8);
}

TEST(ComputeSpectrum, TheSignIsCanonical) {
  const Spectrum found =
      compute_spectrum(compute_operator(make_ellipsoid(1, 1.3, 1.9, 8)), {.count = 20});
  for (const auto& column : found.vectors.colwise()) {
    const double bar = 0.5 * column.cwiseAbs().maxCoeff();
    EXPECT_GT(
        *std::find_if(column.begin(), column.end(), [&](double x) { return std::abs(x) > bar; }),
        0.0);
  }
}

TEST(ComputeSpectrum, StopsWhenToldTo) {
  try {
    (void)compute_spectrum(compute_operator(make_sphere(16)),
                           {.count = 50, .progress = [](const ProgressStep&) { return false; }});
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::cancelled);
  }
}

TEST(ComputeSpectrum, RefusesZeroPairsAndSaysSo) {
  try {
    (void)compute_spectrum(compute_operator(make_sphere(1)), {.count = 0});
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_request);
    EXPECT_STREQ(error.what(), "count: asks for 0 eigenpairs; at least 1 is needed");
  }
}

TEST(ComputeSpectrum, FindsAllOfSmallToriWhateverTheCount) {
  for (const int n : {15, 16, 17}) {
    const IntrinsicMesh torus = make_flat_torus(n);
    const Operator op = compute_operator(torus.faces, torus.lengths, torus.vertices);
    const VectorXd all = compute_spectrum(op, {.count = n * n}).values;
    for (int count = 20; count <= n * n / 4; ++count) {
      const Spectrum found = compute_spectrum(op, {.count = count});
      EXPECT_LT((found.values - all.head(count)).cwiseAbs().maxCoeff(), 1e-8 * all[count - 1]);
      EXPECT_EQ(found.certificate->count, (all.array() < found.certificate->bound).count());
    }
  }
}

TEST(ComputeSpectrum, IsTheSameToTheBitOnAnyNumberOfThreads) {
  for (const MassKind mass : {MassKind::lumped, MassKind::consistent}) {
    const Operator op = compute_operator(make_ellipsoid(1.0, 0.8, 0.6, 32), {.mass = mass});
    const Spectrum one = compute_spectrum(op, {.count = 70, .threads = 1});
    for (const int threads : {2, 3, 0}) {
      const Spectrum many = compute_spectrum(op, {.count = 70, .threads = threads});
      EXPECT_EQ(many.values, one.values) << threads;
      EXPECT_EQ(many.vectors, one.vectors) << threads;
      EXPECT_EQ(many.residuals, one.residuals) << threads;
      EXPECT_EQ(many.orthonormality, one.orthonormality) << threads;
    }
  }
}

TEST(ComputeSpectrum, IsAsGoodAsAskedForAndCompleteAtAnyTolerance) {
  const Operator op = compute_operator(make_ellipsoid(1.0, 0.8, 0.6, 16));
  const Spectrum best = compute_spectrum(op, {.count = 250, .tolerance = 1e-9});
  double last = 0.0;
  for (const double tolerance : {1e-9, 1e-6, 1e-3, 1e-2}) {
    const Spectrum found = compute_spectrum(op, {.count = 250, .tolerance = tolerance});
    const double residual = found.residuals.maxCoeff();
    EXPECT_LE(residual, tolerance);
    EXPECT_GT(residual, last);  // or the larger tolerance saved nothing
    EXPECT_LE(found.orthonormality, std::max(1e-8, 1e-2 * tolerance));
    EXPECT_GE(found.certificate->count, 250);
    EXPECT_LE((found.values - best.values).cwiseAbs().maxCoeff(), tolerance * best.values[249]);
    last = residual;
  }
}

TEST(ComputeSpectrum, RefusesWhatItCannotProve) {
  try {
    (void)compute_spectrum(compute_operator(make_sphere(8)), {.count = 20, .tolerance = 1e-20});
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::not_converged);
  }
}

TEST(FactorizationTest, SolvesAndRefusesAnIndefiniteMatrix) {
  const Operator op = compute_operator(make_sphere(6));
  const SparseMatrix definite = op.stiffness + op.mass;
  const MatrixXd B = MatrixXd::Random(definite.rows(), 37);
  MatrixXd X = B;
  Factorization(definite).solve(X);
  EXPECT_LT((definite * X - B).norm(), 1e-11 * B.norm());
  EXPECT_THROW(Factorization(SparseMatrix(op.stiffness - 3.0 * op.mass)), Error);
}

TEST(AtUnitArea, RescalesValuesAndVectors) {
  const Operator op = compute_operator(make_sphere(4));
  const Spectrum unit = at_unit_area(compute_spectrum(op, {.count = 5}), op.area);
  EXPECT_NEAR(unit.values[1], 2.0 * 4.0 * kPi, 1.5);
  EXPECT_NEAR(unit.vectors.col(1).dot(op.mass * unit.vectors.col(1)), op.area, 1e-9);
}

}  // namespace
}  // namespace timbre

#include "timbre/datasets/closed_form.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numbers>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/spectrum.h"
#include "timbre/datasets/analytic.h"

namespace timbre {
namespace {

constexpr double kPi2 = std::numbers::pi * std::numbers::pi;

void expect_values(const std::vector<double>& found, const std::vector<double>& wanted,
                   double unit = 1.0) {
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_NEAR(found[i], unit * wanted[i], 1e-8 * (1.0 + unit * wanted[i])) << i;
  }
}

TEST(ClosedForm, HasTheFirstEigenvaluesOfEachSurface) {
  expect_values(sphere_eigenvalues(10), {0, 2, 2, 2, 6, 6, 6, 6, 6, 12});
  expect_values(rectangle_eigenvalues(2.0, 1.0, 8), {0, 0.25, 1, 1, 1.25, 2, 2.25, 3.25}, kPi2);
  expect_values(flat_torus_eigenvalues(14), {0, 1, 1, 1, 1, 2, 2, 2, 2, 4, 4, 4, 4, 5}, 4.0 * kPi2);
  const double j = kPi2 / 4.0;
  expect_values(cylinder_eigenvalues(2.0, 10), {0, 1, 1, j, j + 1, j + 1, 4, 4, j + 4, j + 4});
}

// Zeros of the derivatives: Abramowitz and Stegun 1964, table 9.5.
TEST(ClosedForm, HasTheFirstEigenvaluesOfADisk) {
  std::vector<double> wanted = {0.0};
  for (const auto& [zero, times] :
       std::initializer_list<std::pair<double, int>>{{1.8411837813, 2},
                                                     {3.0542369282, 2},
                                                     {3.8317059702, 1},
                                                     {4.2011889412, 2},
                                                     {5.3175531261, 2},
                                                     {5.3314427735, 2},
                                                     {6.4156163757, 2},
                                                     {6.7061331942, 2},
                                                     {7.0155866698, 1}}) {
    wanted.insert(wanted.end(), static_cast<std::size_t>(times), zero * zero);
  }
  expect_values(disk_eigenvalues(static_cast<int>(wanted.size())), wanted);
}

struct Kind {
  const char* name;
  std::function<std::vector<double>(int)> values;
};

class EveryKind : public testing::TestWithParam<Kind> {};

TEST_P(EveryKind, GivesTheBeginningOfOneAscendingList) {
  const std::vector<double> all = GetParam().values(400);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
  EXPECT_EQ(all[0], 0.0);
  EXPECT_GT(all[1], 0.0);
  for (int count = 1; count < 100; ++count) {
    const std::vector<double> some = GetParam().values(count);
    ASSERT_EQ(some.size(), static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < some.size(); ++i) {
      ASSERT_NEAR(some[i], all[i], 1e-9 * (1.0 + all[i])) << count;
    }
  }
}

TEST_P(EveryKind, RefusesToGiveNone) {
  try {
    (void)GetParam().values(0);
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "count: asks for 0 eigenvalues; at least 1 is needed");
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, EveryKind,
    testing::Values(
        Kind{"sphere", sphere_eigenvalues}, Kind{"disk", disk_eigenvalues},
        Kind{"flat_torus", flat_torus_eigenvalues},
        Kind{"rectangle", [](int count) { return rectangle_eigenvalues(2.0, 1.0, count); }},
        Kind{"thin_rectangle", [](int count) { return rectangle_eigenvalues(1.0, 0.01, count); }},
        Kind{"cylinder", [](int count) { return cylinder_eigenvalues(2.0, count); }},
        Kind{"long_cylinder", [](int count) { return cylinder_eigenvalues(50.0, count); }}),
    [](const auto& tested) { return std::string(tested.param.name); });

double worst_error(const TriangleMesh& mesh, const std::vector<double>& wanted) {
  const Spectrum found =
      compute_spectrum(compute_operator(mesh), {.count = static_cast<int>(wanted.size())});
  double worst = 0.0;
  for (std::size_t i = 1; i < wanted.size(); ++i) {
    const double value = found.values(static_cast<Eigen::Index>(i));
    worst = std::max(worst, std::abs(value / wanted[i] - 1.0));
  }
  return worst;
}

// The error falls with the square of the edge.
TEST(MakeCylinder, ConvergesToItsClosedForm) {
  const std::vector<double> wanted = cylinder_eigenvalues(2.0, 15);
  const double coarse = worst_error(make_cylinder(2.0, 24, 11), wanted);
  const double fine = worst_error(make_cylinder(2.0, 96, 41), wanted);
  EXPECT_LT(coarse, 0.1);
  EXPECT_LT(fine, coarse / 12.0);
}

TEST(MakeDisk, ConvergesToItsClosedForm) {
  const std::vector<double> wanted = disk_eigenvalues(15);
  const double coarse = worst_error(make_disk(8), wanted);
  const double fine = worst_error(make_disk(32), wanted);
  EXPECT_LT(coarse, 0.2);
  EXPECT_LT(fine, coarse / 12.0);
}

}  // namespace
}  // namespace timbre

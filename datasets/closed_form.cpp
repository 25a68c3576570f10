#include "timbre/datasets/closed_form.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

constexpr double kPi = std::numbers::pi;

void require_count(int count) {
  if (count >= 1) return;
  throw Error(ErrorKind::bad_request, "", "count",
              "asks for " + std::to_string(count) + " eigenvalues; at least 1 is needed");
}

// The lowest sums a(i) + b(j), both ascending from i = j = 0, a(i) `times(i)` times.
std::vector<double> lowest_sums(const std::function<double(int)>& a,
                                const std::function<int(int)>& times,
                                const std::function<double(int)>& b, int count) {
  require_count(count);
  std::vector<double> values;
  // The first `count` of either alone bound what is needed of both.
  const double bound = std::min(a(count), b(count));
  for (int i = 0; a(i) <= bound; ++i) {
    for (int j = 0; a(i) + b(j) <= bound; ++j) {
      values.insert(values.end(), static_cast<std::size_t>(times(i)), a(i) + b(j));
    }
  }
  std::sort(values.begin(), values.end());
  values.resize(static_cast<std::size_t>(count));
  return values;
}

double squared(double x) { return x * x; }

double bessel_slope(int order, double x) {
  if (order == 0) return -std::cyl_bessel_j(1.0, x);
  return 0.5 * (std::cyl_bessel_j(order - 1.0, x) - std::cyl_bessel_j(order + 1.0, x));
}

double zero_between(int order, double low, double high) {
  const bool rises = bessel_slope(order, low) < 0.0;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    ((bessel_slope(order, middle) < 0.0) == rises ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::vector<double> sphere_eigenvalues(int count) {
  require_count(count);
  std::vector<double> values;
  for (int l = 0; static_cast<int>(values.size()) < count; ++l) {
    values.insert(values.end(), 2 * static_cast<std::size_t>(l) + 1, l * (l + 1.0));
  }
  values.resize(static_cast<std::size_t>(count));
  return values;
}

std::vector<double> rectangle_eigenvalues(double width, double height, int count) {
  return lowest_sums([&](int i) { return squared(kPi * i / width); }, [](int) { return 1; },
                     [&](int j) { return squared(kPi * j / height); }, count);
}

std::vector<double> disk_eigenvalues(int count) {
  require_count(count);
  // Weyl's law with its boundary term puts `count` values below this, and some more.
  const double most = std::sqrt(4.0 * count) + 4.0;
  constexpr double kStep = 0.1;  // zeros of one order lie about pi apart
  std::vector<double> values = {0.0};
  for (int order = 0; order <= most; ++order) {
    for (int step = 1; step * kStep < most; ++step) {
      const double x = step * kStep;
      if ((bessel_slope(order, x) < 0.0) == (bessel_slope(order, x + kStep) < 0.0)) continue;
      const double value = squared(zero_between(order, x, x + kStep));
      values.insert(values.end(), order == 0 ? 1U : 2U, value);
    }
  }
  std::sort(values.begin(), values.end());
  values.resize(static_cast<std::size_t>(count));
  return values;
}

std::vector<double> cylinder_eigenvalues(double height, int count) {
  return lowest_sums([](int m) { return squared(m); }, [](int m) { return m == 0 ? 1 : 2; },
                     [&](int j) { return squared(kPi * j / height); }, count);
}

std::vector<double> flat_torus_eigenvalues(int count) {
  require_count(count);
  std::vector<double> values;
  // Values up to 4 pi^2 r^2 number about pi r^2.
  const int r = static_cast<int>(std::sqrt(count / kPi)) + 3;
  for (int i = -r; i <= r; ++i) {
    for (int j = -r; j <= r; ++j) {
      if (i * i + j * j <= r * r) values.push_back(4.0 * kPi * kPi * (i * i + j * j));
    }
  }
  std::sort(values.begin(), values.end());
  values.resize(static_cast<std::size_t>(count));
  return values;
}

}  // namespace timbre

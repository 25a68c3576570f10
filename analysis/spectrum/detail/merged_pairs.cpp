#include "timbre/analysis/spectrum/detail/merged_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/huge_pages.h"
#include "timbre/analysis/core/number_text.h"

namespace timbre::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kGuard = 10;  // pairs of a component beyond its share

Index used_rows(const Operator& op) { return (op.lumped_mass.array() > 0.0).count(); }

int checked_count(const Operator& op, const SpectrumOptions& options) {
  if (options.count < 1) {
    throw Error(ErrorKind::bad_request, "", "count",
                "asks for " + std::to_string(options.count) + " eigenpairs; at least 1 is needed");
  }
  if (op.stiffness.rows() != op.mass.rows()) {
    throw Error(ErrorKind::bad_request, "", "operator",
                "stiffness has " + std::to_string(op.stiffness.rows()) + " rows, mass has " +
                    std::to_string(op.mass.rows()));
  }
  return options.count;
}

// Half the largest entry, not the largest itself: the largest is often shared by two
// symmetric vertices, and rounding then picks one or the other.
double canonical_sign(const Eigen::Ref<const VectorXd>& vector) {
  const double bar = 0.5 * vector.cwiseAbs().maxCoeff();
  for (const double x : vector) {
    if (std::abs(x) > bar) return x < 0.0 ? -1.0 : 1.0;
  }
  return 1.0;
}

// From the component at unit area to true scale.
double scale_of(const Component& part, const Eigen::Ref<const VectorXd>& vector) {
  return canonical_sign(vector) / std::sqrt(part.area);
}

}  // namespace

// Weyl: a component's share of the low pairs is its share of the area.
MergedPairs::MergedPairs(const Operator& op, const SpectrumOptions& options, Vectors vectors)
    : options_(options),
      forgets_(vectors == Vectors::forget),
      rows_(op.stiffness.rows()),
      wanted_(std::min<Index>(checked_count(op, options), used_rows(op))),
      area_(op.area),
      expected_solves_(5 * (wanted_ + kGuard) / 2),
      reporter_(options.progress, "eigenpairs", expected_solves_) {
  std::vector<Component> components = split_into_components(op);
  for (Component& part : components) {
    const double share = part.area / area_ * static_cast<double>(wanted_);
    const Index count =
        components.size() == 1 ? wanted_ : static_cast<Index>(std::ceil(share)) + kGuard;
    components_.emplace_back(std::move(part),
                             ComponentSolveOptions{.count = std::min(count, wanted_),
                                                   .tolerance = 1e-3 * options.tolerance,
                                                   .certify = options.certify,
                                                   .backend = options.backend,
                                                   .keep_all = !forgets_,
                                                   .threads = options.threads,
                                                   .on_solve =
                                                       [this](int solves) {
                                                         // An estimate; never show more than all.
                                                         solves_ = std::min(solves_ + solves,
                                                                            expected_solves_ - 1);
                                                         reporter_.advance_to(solves_);
                                                       },
                                                   .clock = &clock_});
  }
  handed_on_of_.resize(components_.size());
}

// Below this every component's pairs are known; infinite once all are exhausted.
double MergedPairs::horizon() const {
  double horizon = std::numeric_limits<double>::infinity();
  for (const ComponentSolver& part : components_) {
    horizon = std::min(horizon, part.bound() / part.component().area);
  }
  return horizon;
}

// Pairs not handed on yet below the horizon, ascending.
std::vector<MergedPair> MergedPairs::known() const {
  const double end = horizon();
  std::vector<MergedPair> known;
  for (std::size_t c = 0; c < components_.size(); ++c) {
    const ComponentSolver& part = components_[c];
    for (Index i = handed_on_of_[c]; i < part.certain(); ++i) {
      const double value = part.pairs().value(i) / part.component().area;
      if (value < end) known.push_back({value, c, i});
    }
  }
  std::stable_sort(known.begin(), known.end(),
                   [](const MergedPair& a, const MergedPair& b) { return a.value < b.value; });
  return known;
}

// The component that holds the others back.
void MergedPairs::advance() {
  const auto lowest =
      std::min_element(components_.begin(), components_.end(), [](const auto& a, const auto& b) {
        return a.bound() / a.component().area < b.bound() / b.component().area;
      });
  lowest->advance();
}

void MergedPairs::forget_handed_on() {
  for (std::size_t c = 0; c < components_.size(); ++c) {
    components_[c].forget_before(handed_on_of_[c]);
  }
}

std::vector<MergedPair> MergedPairs::next() {
  if (forgets_) forget_handed_on();
  const Index missing = wanted_ - handed_on();
  if (missing == 0) return {};
  std::vector<MergedPair> ready = known();
  for (; ready.empty(); ready = known()) advance();
  ready.resize(std::min(ready.size(), static_cast<std::size_t>(missing)));
  for (const MergedPair& pair : ready) ++handed_on_of_[pair.component];
  handed_on_.insert(handed_on_.end(), ready.begin(), ready.end());
  return ready;
}

void MergedPairs::write_vector(const MergedPair& pair, double* column) const {
  const Component& part = components_[pair.component].component();
  const auto vector = components_[pair.component].pairs().vectors(pair.pair, 1).col(0);
  const double scale = scale_of(part, vector);
  if (part.size() < rows_) std::fill_n(column, rows_, 0.0);
  for (Index i = 0; i < part.size(); ++i) {
    column[part.vertices[static_cast<std::size_t>(i)]] = scale * vector[i];
  }
}

// Those of a connected mesh are the result as they lie.
MatrixXd MergedPairs::release_vectors() {
  if (components_.size() == 1 && components_[0].component().size() == rows_) {
    MatrixXd vectors = components_[0].release_vectors(wanted_);
    for (auto column : vectors.colwise()) column *= scale_of(components_[0].component(), column);
    return vectors;
  }
  MatrixXd vectors(rows_, wanted_);
  prefer_huge_pages(vectors.data(), static_cast<std::size_t>(vectors.size()) * sizeof(double));
  for (Index j = 0; j < wanted_; ++j) {
    write_vector(handed_on_[static_cast<std::size_t>(j)], vectors.col(j).data());
  }
  return vectors;
}

// In a gap of the merged list behind the last wanted pair: right after it if the gap there is
// clear, else in the widest that is known.
Certificate MergedPairs::certify() {
  constexpr double kLeastGap = 1e-9;
  constexpr double kClearGap = 1e-5;
  constexpr int kRounds = 5;
  for (int round = 0; round < kRounds; ++round, advance()) {
    const std::vector<MergedPair> behind = known();
    const double end = horizon();
    Certificate best;
    double widest = kLeastGap;
    double below = handed_on_.back().value;
    for (std::size_t j = 0; j <= behind.size() && widest < kClearGap; ++j) {
      const bool is_last = j == behind.size();
      const double above = !is_last             ? behind[j].value
                           : std::isfinite(end) ? end
                                                : 2.0 * below + 1.0 / area_;
      const double gap = (above - below) / above;
      if (gap > widest) {
        widest = gap;
        best = {0.5 * (below + above), handed_on() + static_cast<std::int64_t>(j), {}};
      }
      below = above;
    }
    if (best.count == 0) continue;
    best.shifts = shifts();
    return best;
  }
  throw Error(ErrorKind::not_converged, "", "spectrum",
              "no gap for a bound was found among the eigenvalues");
}

Spectrum MergedPairs::finish() {
  Spectrum found;
  if (options_.certify) found.certificate = certify();
  found.values.resize(wanted_);
  for (Index j = 0; j < wanted_; ++j) {
    found.values[j] = handed_on_[static_cast<std::size_t>(j)].value;
  }
  found.zeros = static_cast<int>((found.values.array() == 0.0).count());
  found.residuals = residuals();
  found.orthonormality = orthonormality();
  found.phases = clock_.seconds();
  check(found);
  return found;
}

// Beside the largest eigenvalue returned of the same component.
VectorXd MergedPairs::residuals() const {
  std::vector<double> largest(components_.size(), 0.0);
  const auto own_value = [&](const MergedPair& pair) {
    return pair.value * components_[pair.component].component().area;
  };
  for (const MergedPair& pair : handed_on_) {
    largest[pair.component] = std::max(largest[pair.component], own_value(pair));
  }
  VectorXd residuals(wanted_);
  for (Index j = 0; j < wanted_; ++j) {
    const MergedPair& pair = handed_on_[static_cast<std::size_t>(j)];
    // A lone constant has no scale of its own; Weyl's density gives it one.
    const double end = largest[pair.component];
    const double scale = end > 0.0 ? end : 4.0 * std::numbers::pi;
    residuals[j] = components_[pair.component].error(pair.pair) / (own_value(pair) + scale);
  }
  return residuals;
}

void MergedPairs::check(const Spectrum& found) const {
  const double most = 1e-2 * std::max(options_.tolerance, 1e-6);  // 1e-8 unless less is asked for
  Index worst = 0;
  const double residual = found.residuals.maxCoeff(&worst);
  // Written so that NaN fails.
  if (!(residual <= options_.tolerance)) {
    throw Error(ErrorKind::not_converged, "", "eigenpair " + std::to_string(worst),
                "residual " + to_text(residual) + " is above " + to_text(options_.tolerance));
  }
  if (!(found.orthonormality <= most)) {
    throw Error(ErrorKind::not_converged, "", "eigenvectors",
                "orthonormal only to " + to_text(found.orthonormality));
  }
}

double MergedPairs::orthonormality() const {
  double worst = 0.0;
  for (const ComponentSolver& part : components_) worst = std::max(worst, part.orthonormality());
  return worst;
}

// Of all components, at true scale.
std::vector<InertiaCount> MergedPairs::shifts() const {
  std::vector<InertiaCount> all;
  for (std::size_t c = 0; c < components_.size(); ++c) {
    const double area = components_[c].component().area;
    for (const SliceReport& slice : components_[c].slices()) {
      all.push_back({static_cast<int>(c), slice.shift / area, slice.below, slice.accepted});
    }
  }
  return all;
}

}  // namespace timbre::detail

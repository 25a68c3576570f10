#include "timbre/analysis/spectrum/spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/matrix_product.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/analysis/spectrum/detail/component_solver.h"

namespace timbre {
namespace {

using detail::Component;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kAttempts = 3;
constexpr Index kGuard = 10;  // pairs beyond those wanted, among which to find a gap

// One eigenvalue of the union, at true scale.
struct Entry {
  double value = 0.0;
  std::size_t component = 0;
  Index pair = 0;
};

std::vector<Entry> merged(const std::vector<Component>& components) {
  std::vector<Entry> all;
  for (std::size_t c = 0; c < components.size(); ++c) {
    for (Index i = 0; i < components[c].values.size(); ++i) {
      all.push_back({components[c].values[i] / components[c].area, c, i});
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Entry& a, const Entry& b) { return a.value < b.value; });
  return all;
}

// Below this every component's pairs are known; infinite once all are exhausted.
double horizon_of(const std::vector<Component>& components) {
  double horizon = std::numeric_limits<double>::infinity();
  for (const Component& part : components) {
    if (part.exhausted()) continue;
    const Index known = part.values.size();
    horizon = std::min(horizon, known == 0 ? 0.0 : part.values[known - 1] / part.area);
  }
  return horizon;
}

Index used_vertices(const Operator& op) { return (op.lumped_mass.array() > 0.0).count(); }

class Solver {
 public:
  Solver(const Operator& op, const SpectrumOptions& options)
      : options_(options),
        size_(op.stiffness.rows()),
        total_area_(op.area),
        wanted_(std::min<Index>(options.count, used_vertices(op))),
        components_(detail::split_into_components(op)),
        expected_solves_(5 * (wanted_ + kGuard) / 2),
        reporter_(options.progress, "eigenpairs", expected_solves_) {}

  Spectrum run() {
    for (int attempt = 0;; ++attempt) {
      try {
        solve_all(attempt);
        Spectrum found;
        if (options_.certify) found.certificate = certify(attempt);
        assemble(found);
        check(found);
        return found;
      } catch (const Error& error) {
        if (error.kind() != ErrorKind::not_converged || attempt + 1 == kAttempts) throw;
      }
    }
  }

 private:
  detail::ComponentSolveOptions solve_options(int attempt) {
    return {attempt, [this](int solves) {
              // The number of solves is an estimate; never show more than all.
              solves_ = std::min(solves_ + solves, expected_solves_ - 1);
              reporter_.advance_to(solves_);
            }};
  }

  // Weyl: a component's share of the low pairs is its share of the area. Where that
  // was too few, the component is asked for twice as many.
  void solve_all(int attempt) {
    for (std::size_t c = 0; c < components_.size(); ++c) {
      const double share = components_[c].area / total_area_;
      extend(c, static_cast<Index>(std::ceil(share * static_cast<double>(wanted_))) + kGuard,
             attempt);
    }
    while (!enough_known()) {
      require_finite();
      for (std::size_t c = 0; c < components_.size(); ++c) {
        if (is_short(components_[c])) extend(c, 2 * components_[c].values.size(), attempt);
      }
    }
  }

  void require_finite() const {
    for (const Component& part : components_) {
      if (part.values.allFinite()) continue;
      throw Error(ErrorKind::not_converged, "", "spectrum", "eigenvalues are not finite");
    }
  }

  void extend(std::size_t c, Index count, int attempt) {
    // One component needs no more than all wanted pairs and the guard, and the first
    // guess says just that; more is asked only when a cluster straddles the end.
    detail::solve_lowest(components_[c], count, solve_options(attempt));
  }

  [[nodiscard]] double needed() const {
    const std::vector<Entry> all = merged(components_);
    const auto last = static_cast<std::size_t>(wanted_ - 1);
    return last < all.size() ? all[last].value : std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] bool enough_known() const { return horizon_of(components_) >= needed(); }

  [[nodiscard]] bool is_short(const Component& part) const {
    return !part.exhausted() && part.values[part.values.size() - 1] / part.area < needed();
  }

  // A bound in a gap of the merged list, at or after the last wanted pair: right
  // after it if the gap there is clear, else in the widest that is known.
  struct Cut {
    double below = 0.0;  ///< the last eigenvalue under the gap
    double above = 0.0;  ///< the first over it
    std::size_t count = 0;
  };
  [[nodiscard]] std::optional<Cut> find_cut() const {
    const std::vector<Entry> all = merged(components_);
    const double horizon = horizon_of(components_);
    std::optional<Cut> widest;
    double widest_gap = 1e-9;
    for (auto j = static_cast<std::size_t>(wanted_); j <= all.size(); ++j) {
      const double below = all[j - 1].value;
      const bool last = j == all.size();
      if (last && std::isfinite(horizon)) break;
      const double above = last ? 2.0 * below + 1.0 / total_area_ : all[j].value;
      if (above > horizon) break;
      const double gap = (above - below) / above;
      if (gap <= widest_gap) continue;
      widest = Cut{below, above, j};
      widest_gap = gap;
      if (gap > 1e-5) break;
    }
    return widest;
  }

  // Counts the eigenvalues of each component below the cut by inertia.
  Certificate certify(int attempt) {
    constexpr int kRounds = 5;
    for (int round = 0; round < kRounds; ++round) {
      if (const std::optional<Cut> cut = find_cut()) {
        const Count counted = count_below(*cut);
        for (std::size_t c = 0; c < components_.size(); ++c) require_agreement(c, counted);
        return {counted.bound, static_cast<std::int64_t>(cut->count)};
      }
      extend_all(attempt);
    }
    throw Error(ErrorKind::not_converged, "", "spectrum",
                "no gap for a bound was found among the eigenvalues");
  }

  struct Count {
    double bound = 0.0;
    std::vector<std::int64_t> of_component;
  };

  // Without pivoting a factorisation can meet a 0 although the shift is no eigenvalue;
  // another shift in the same gap does not.
  [[nodiscard]] Count count_below(const Cut& cut) const {
    constexpr std::array kPlaces = {0.5, 0.4, 0.62, 0.3, 0.71, 0.2};
    for (std::size_t i = 0;; ++i) {
      try {
        Count count{cut.below + kPlaces[i] * (cut.above - cut.below), {}};
        for (const Component& part : components_) {
          const double shift = count.bound * part.area;
          count.of_component.push_back(count_negative_eigenvalues(
              SparseMatrix(part.stiffness - shift * part.mass), options_.backend));
        }
        return count;
      } catch (const Error& error) {
        if (error.kind() != ErrorKind::not_converged || i + 1 == kPlaces.size()) throw;
      }
    }
  }

  void extend_all(int attempt) {
    for (std::size_t c = 0; c < components_.size(); ++c) {
      if (!components_[c].exhausted()) {
        extend(c, components_[c].values.size() + 2 * kGuard, attempt);
      }
    }
  }

  void require_agreement(std::size_t c, const Count& count) const {
    const Component& part = components_[c];
    const std::int64_t known = (part.values.array() < count.bound * part.area).count();
    if (count.of_component[c] == known) return;
    throw Error(ErrorKind::not_converged, "", "spectrum",
                std::to_string(known) + " eigenvalues found below " + to_text(count.bound) +
                    ", but inertia counts " + std::to_string(count.of_component[c]));
  }

  void assemble(Spectrum& found) const {
    const std::vector<Entry> all = merged(components_);
    found.values.resize(wanted_);
    found.vectors = MatrixXd::Zero(size_, wanted_);
    found.residuals.resize(wanted_);
    std::vector<VectorXd> residuals;
    for (const Component& part : components_) {
      residuals.push_back(detail::relative_residuals(part));
    }
    for (Index j = 0; j < wanted_; ++j) {
      const Entry& entry = all[static_cast<std::size_t>(j)];
      const Component& part = components_[entry.component];
      found.values[j] = entry.value;
      found.residuals[j] = residuals[entry.component][entry.pair];
      const double scale = canonical_sign(part, entry.pair) / std::sqrt(part.area);
      for (Index i = 0; i < part.size(); ++i) {
        found.vectors(part.vertices[static_cast<std::size_t>(i)], j) =
            scale * part.vectors(i, entry.pair);
      }
      if (entry.value == 0.0) ++found.zeros;
    }
    found.orthonormality = orthonormality_error();
  }

  // Half the largest entry, not the largest itself: the largest is often shared by two
  // symmetric vertices, and rounding then picks one or the other.
  static double canonical_sign(const Component& part, Index pair) {
    const auto column = part.vectors.col(pair);
    const double bar = 0.5 * column.cwiseAbs().maxCoeff();
    for (const double x : column) {
      if (std::abs(x) > bar) return x < 0.0 ? -1.0 : 1.0;
    }
    return 1.0;
  }

  [[nodiscard]] double orthonormality_error() const {
    double worst = 0.0;
    for (const Component& part : components_) {
      const MatrixXd gram = product_at_b(part.vectors, MatrixXd(part.mass * part.vectors));
      worst = std::max(worst,
                       (gram - MatrixXd::Identity(gram.rows(), gram.cols())).cwiseAbs().maxCoeff());
    }
    return worst;
  }

  void check(const Spectrum& found) const {
    constexpr double kOrthonormality = 1e-8;
    Index worst = 0;
    const double residual = found.residuals.maxCoeff(&worst);
    // Written so that NaN fails.
    if (!(residual <= options_.tolerance)) {
      throw Error(ErrorKind::not_converged, "", "eigenpair " + std::to_string(worst),
                  "residual " + to_text(residual) + " is above " + to_text(options_.tolerance));
    }
    if (!(found.orthonormality <= kOrthonormality)) {
      throw Error(ErrorKind::not_converged, "", "eigenvectors",
                  "orthonormal only to " + to_text(found.orthonormality));
    }
  }

  const SpectrumOptions& options_;
  Index size_;
  double total_area_;
  Index wanted_;
  std::vector<Component> components_;
  Index expected_solves_;
  ProgressReporter reporter_;
  Index solves_ = 0;
};

void require_request_makes_sense(const Operator& op, const SpectrumOptions& options) {
  if (options.count < 1) {
    throw Error(ErrorKind::bad_request, "", "count",
                "asks for " + std::to_string(options.count) + " eigenpairs; at least 1 is needed");
  }
  if (op.stiffness.rows() != op.mass.rows()) {
    throw Error(ErrorKind::bad_request, "", "operator",
                "stiffness has " + std::to_string(op.stiffness.rows()) + " rows, mass has " +
                    std::to_string(op.mass.rows()));
  }
}

}  // namespace

Spectrum compute_spectrum(const Operator& op, const SpectrumOptions& options) {
  require_request_makes_sense(op, options);
  const SingleThreadedBlas blas;
  return Solver(op, options).run();
}

Spectrum at_unit_area(Spectrum spectrum, double area) {
  spectrum.values *= area;
  spectrum.vectors *= std::sqrt(area);
  if (spectrum.certificate) spectrum.certificate->bound *= area;
  return spectrum;
}

Spectrum at_vertices(Spectrum spectrum, const Operator& op) {
  if (spectrum.vectors.rows() > op.vertices) {
    spectrum.vectors = Eigen::MatrixXd(spectrum.vectors.topRows(op.vertices));
  }
  return spectrum;
}

}  // namespace timbre

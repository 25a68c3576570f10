#include "timbre/matching/match.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "timbre/analysis/core/stopwatch.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/matching/candidates.h"
#include "timbre/matching/detail/stages.h"

namespace timbre {
namespace {

using Eigen::Index;

// Space counts from the start, at small sizes, where it still moves the map.
constexpr std::array kDenseSteps = {DenseStep{100, 2.0, 0.005, 40}, DenseStep{120, 2.0, 0.005, 60},
                                    DenseStep{150, 2.0, 0.005, 100},
                                    DenseStep{200, 2.0, 0.005, 150}};
constexpr double kCloseEnergy = 0.25;  // closer than this: compare after dense refinement
constexpr double kMirrorPenalty = 2.0;
// A generic shape has simple eigenvalues; a group of rotations makes most of them multiple.
constexpr double kRepeated = 0.6;
constexpr double kDoubtEnergy = 0.1;  // closer than this: say so

struct Rival {
  Candidate candidate;
  SampledMaps sampled;
  MapEnergies energies;
  double sample_energy = 0.0;
  FunctionalMaps functional;
  double energy = 0.0;
  DenseMaps dense;  ///< of those that were refined
};

class Matcher {
 public:
  Matcher(const MatchSurface& A, const MatchSurface& B, const MatchOptions& options)
      : a_(A),
        b_(B),
        options_(options),
        sided_(A.orientation != Orientation::none && B.orientation != Orientation::none),
        oriented_(A.orientation == Orientation::outward && B.orientation == Orientation::outward),
        reporter_(options.progress, "matching", 4) {}

  MatchResult run() {
    MatchResult result;
    Stopwatch watch;
    std::vector<Candidate> candidates = search();
    result.timings.search = watch.lap();
    reporter_.advance();
    std::vector<Rival> rivals = compare_on_samples(std::move(candidates));
    result.timings.samples = watch.lap();
    reporter_.advance();
    compare_on_vertices(rivals);
    result.timings.vertices = watch.lap();
    reporter_.advance();
    refine_best(rivals);
    result.timings.dense = watch.lap();
    reporter_.advance();
    report(rivals, result);
    return result;
  }

 private:
  std::vector<Candidate> search() {
    std::array<std::vector<Candidate>, 2> found;
    parallel_for(2, options_.threads, [&](std::int64_t i) {
      found[static_cast<std::size_t>(i)] = search_candidates(a_, b_, i == 0 ? 1 : -1);
    });
    std::vector<Candidate> all;
    for (std::vector<Candidate>& half : found) {
      if (half.size() > static_cast<std::size_t>(options_.candidates)) {
        half.resize(static_cast<std::size_t>(options_.candidates));
      }
      std::move(half.begin(), half.end(), std::back_inserter(all));
    }
    return all;
  }

  std::vector<Rival> compare_on_samples(std::vector<Candidate> candidates) {
    std::vector<Rival> all(candidates.size());
    parallel_for(static_cast<std::int64_t>(all.size()), options_.threads, [&](std::int64_t i) {
      Rival& rival = all[static_cast<std::size_t>(i)];
      rival.candidate = std::move(candidates[static_cast<std::size_t>(i)]);
      rival.sampled = zoom_out_on_samples(a_, b_, rival.candidate.C, detail::kSampleSizes);
      rival.energies = measure_energies(a_, b_, rival.sampled);
      rival.sample_energy = sample_score(rival.energies, rival.candidate.orientation);
    });
    std::stable_sort(all.begin(), all.end(), [](const Rival& x, const Rival& y) {
      return x.sample_energy < y.sample_energy;
    });
    std::vector<Rival> kept;
    for (const int orientation : {1, -1}) keep_distinct(all, orientation, kept);
    return kept;
  }

  // The best few of one orientation, no two nearly the same map. The search's own
  // favourite always passes: its score and the energies err on different shapes.
  void keep_distinct(std::vector<Rival>& all, int orientation, std::vector<Rival>& kept) {
    std::vector<Rival*> own;
    for (Rival& rival : all) {
      if (rival.candidate.orientation == orientation) own.push_back(&rival);
    }
    if (own.empty()) return;
    const auto favourite = std::max_element(own.begin(), own.end(), [](Rival* x, Rival* y) {
      return x->candidate.score() < y->candidate.score();
    });
    std::rotate(own.begin(), favourite, favourite + 1);
    const int wanted = oriented_ && orientation < 0 ? 1 : options_.rivals;
    std::vector<Rival> distinct = detail::first_distinct(a_, b_, own, wanted);
    std::move(distinct.begin(), distinct.end(), std::back_inserter(kept));
  }

  void compare_on_vertices(std::vector<Rival>& rivals) {
    parallel_for(static_cast<std::int64_t>(rivals.size()), options_.threads, [&](std::int64_t i) {
      Rival& rival = rivals[static_cast<std::size_t>(i)];
      rival.functional = zoom_out_to_vertices(a_, b_, rival.sampled.functional,
                                              detail::kVertexSizes, detail::kVertexSamples, 1);
      const double bands = curvature_bands(a_, b_, rival.functional);
      const double commutation =
          commutation_error(a_, b_, rival.functional.ab, rival.functional.ab.rows());
      rival.energy = 0.3 * rival.sample_energy - 3.0 * bands + 2.0 * commutation -
                     4.0 * rival.candidate.score();
    });
    for (Rival& rival : rivals) {
      if (misoriented(rival)) rival.energy += kMirrorPenalty;
    }
    sort_by_energy(rivals);
  }

  static void sort_by_energy(std::vector<Rival>& rivals) {
    std::stable_sort(rivals.begin(), rivals.end(),
                     [](const Rival& x, const Rival& y) { return x.energy < y.energy; });
  }

  [[nodiscard]] bool misoriented(const Rival& rival) const {
    return sided_ && rival.candidate.orientation < 0;
  }

  void refine(Rival& rival) {
    rival.dense = refine_densely(a_, b_, rival.functional, kDenseSteps, rival.candidate.orientation,
                                 options_.threads);
  }

  // Those close to the best are refined too and compared again. Dense scores differ by
  // a fifth of what energies differ by.
  void refine_best(std::vector<Rival>& rivals) {
    if (rivals.empty()) return;
    const double best = rivals[0].energy;
    const bool mirrored = misoriented(rivals[0]);
    std::vector<Rival*> close;
    for (Rival& rival : rivals) {
      if (misoriented(rival) == mirrored && rival.energy - best <= kCloseEnergy) {
        close.push_back(&rival);
      }
    }
    std::vector<double> scores;
    for (Rival* rival : close) {
      refine(*rival);
      if (close.size() > 1) {
        scores.push_back(dense_score(a_, b_, rival->dense, rival->candidate.orientation));
      }
    }
    if (scores.empty()) return;
    const double least = *std::min_element(scores.begin(), scores.end());
    for (std::size_t i = 0; i < close.size(); ++i) {
      close[i]->energy = best + 5.0 * (scores[i] - least);
    }
    sort_by_energy(rivals);
  }

  void report(std::vector<Rival>& rivals, MatchResult& result) {
    result.ab.assign(static_cast<std::size_t>(a_.file_vertices), -1);
    result.ba.assign(static_cast<std::size_t>(b_.file_vertices), -1);
    if (rivals.empty()) {
      result.reason = "the shapes have too few eigenfunctions to compare";
      return;
    }
    double total = 0.0;
    for (Rival& rival : rivals) {
      MatchSolution solution;
      solution.energy = rival.energy;
      solution.orientation = !oriented_                        ? MapOrientation::unknown
                             : rival.candidate.orientation > 0 ? MapOrientation::direct
                                                               : MapOrientation::mirrored;
      solution.energies = rival.energies;
      solution.coverage = rival.energies.coverage;
      solution.confidence = std::exp((rivals[0].energy - rival.energy) / kDoubtEnergy);
      total += solution.confidence;
      solution.functional =
          rival.dense.points.ab.empty() ? rival.functional : rival.dense.functional;
      result.solutions.push_back(std::move(solution));
    }
    for (MatchSolution& solution : result.solutions) solution.confidence /= total;
    const PointMaps& points = rivals[0].dense.points;
    result.solutions[0].coverage =
        0.5 * (covered_area(b_, points.ab) + covered_area(a_, points.ba));
    result.switches = find_switches(result.solutions[0].functional.ab, 20);
    result.ab = between_files(a_, b_, points.ab);
    result.ba = between_files(b_, a_, points.ba);
    judge(result);
  }

  void judge(MatchResult& result) const {
    const MatchSolution& best = result.solutions[0];
    const auto second = std::find_if(
        result.solutions.begin() + 1, result.solutions.end(),
        [&](const MatchSolution& other) { return other.orientation == best.orientation; });
    // Written so that NaN fails.
    const bool plausible =
        best.energies.geodesic <= 0.16 && (!sided_ || std::abs(best.energies.areas) >= 0.3);
    if (!plausible) {
      result.verdict = Verdict::failed;
      result.reason = "the best map stretches distances and area forms too much to be one";
    } else if (!oriented_) {
      result.verdict = Verdict::ambiguous;
      result.reason = sided_ ? "a shape is open: left and right hang on the side its faces show"
                             : "a shape is one-sided: left and right cannot be told apart";
    } else if (repeated_share(a_) > kRepeated || repeated_share(b_) > kRepeated) {
      result.verdict = Verdict::ambiguous;
      result.reason = "eigenvalues come in groups: a shape can be turned onto itself";
    } else if (second != result.solutions.end() && second->energy - best.energy < kDoubtEnergy) {
      result.verdict = Verdict::ambiguous;
      result.reason = "another map is nearly as good";
    } else {
      result.verdict = Verdict::clear;
    }
  }

  // Share of the low eigenvalues that have another within a hundredth.
  static double repeated_share(const MatchSurface& s) {
    const Index count = std::min<Index>(20, s.values.size() - 2);
    Index repeated = 0;
    for (Index i = 1; i <= count; ++i) {
      const bool below = i > 1 && s.values[i] < 1.01 * s.values[i - 1];
      const bool above = s.values[i + 1] < 1.01 * s.values[i];
      if (below || above) ++repeated;
    }
    return static_cast<double>(repeated) / static_cast<double>(count);
  }

  const MatchSurface& a_;
  const MatchSurface& b_;
  const MatchOptions& options_;
  bool sided_;     // both have consistent faces: the files' word for which side is out
  bool oriented_;  // both enclose a volume, which proves it
  ProgressReporter reporter_;
};

}  // namespace

MatchResult match(const MatchSurface& A, const MatchSurface& B, const MatchOptions& options) {
  detail::require_at_least("candidates", options.candidates, 1);
  detail::require_at_least("rivals", options.rivals, 1);
  const SingleThreadedBlas blas;
  return Matcher(A, B, options).run();
}

const char* to_word(Verdict verdict) {
  switch (verdict) {
    case Verdict::clear:
      return "clear";
    case Verdict::ambiguous:
      return "ambiguous";
    case Verdict::failed:
      break;
  }
  return "failed";
}

const char* to_word(MapOrientation orientation) {
  switch (orientation) {
    case MapOrientation::direct:
      return "direct";
    case MapOrientation::mirrored:
      return "mirrored";
    case MapOrientation::unknown:
      break;
  }
  return "unknown";
}

}  // namespace timbre

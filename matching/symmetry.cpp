#include "timbre/matching/symmetry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "timbre/analysis/core/threads.h"
#include "timbre/matching/candidates.h"
#include "timbre/matching/deformation.h"
#include "timbre/matching/detail/stages.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr std::array kDenseSizes = {100, 125, 150};
constexpr double kStretched = 0.1;  // beyond this mean change of distances it is no symmetry
constexpr double kEnergyScale = 0.03;

struct Rival {
  SampledMaps sampled;
  MapEnergies energies;
  double sample_energy = 0.0;
  MatrixXd C;
  PointMap points;
  double displacement = 0.0;
  double involution = 0.0;
  double energy = 0.0;
};

// Switches of few functions, and signs of many: a simple spectrum makes C nearly diagonal.
std::vector<Candidate> search(const MatchSurface& s, const SymmetryOptions& options) {
  constexpr std::array kSearches = {
      CandidateOptions{.displacement = 2, .kept_seeds = 512, .kept_polished = 96, .kept_grown = 32},
      CandidateOptions{.seed_size = 10, .displacement = 0}};
  std::array<std::vector<Candidate>, kSearches.size()> found;
  parallel_for(found.size(), options.threads, [&](std::int64_t i) {
    const auto at = static_cast<std::size_t>(i);
    found[at] = search_candidates(s, s, -1, kSearches[at]);
  });
  std::vector<Candidate> all = std::move(found[0]);
  std::move(found[1].begin(), found[1].end(), std::back_inserter(all));
  return without_duplicates(std::move(all), 0.2, static_cast<std::size_t>(options.candidates));
}

MatrixXd symmetric_part(const MatrixXd& C) { return 0.5 * (C + C.transpose()); }

std::vector<Rival> compare_on_samples(const MatchSurface& s, const std::vector<Candidate>& found,
                                      const SymmetryOptions& options) {
  std::vector<Rival> all(found.size());
  parallel_for(static_cast<std::int64_t>(all.size()), options.threads, [&](std::int64_t i) {
    const auto at = static_cast<std::size_t>(i);
    Rival& rival = all[at];
    rival.sampled = zoom_out_on_samples(s, s, symmetric_part(found[at].C), detail::kSampleSizes);
    rival.energies = measure_energies(s, s, rival.sampled);
    rival.sample_energy = sample_score(rival.energies, -1);
    rival.C = 0.5 * (rival.sampled.functional.ab + rival.sampled.functional.ba);
  });
  std::stable_sort(all.begin(), all.end(), [](const Rival& x, const Rival& y) {
    return x.sample_energy < y.sample_energy;
  });
  std::vector<Rival*> ranked(all.size());
  std::transform(all.begin(), all.end(), ranked.begin(), [](Rival& rival) { return &rival; });
  return detail::first_distinct(s, s, ranked, options.rivals);
}

// One map serves both directions, because C is symmetric.
PointMap nearest_images(const MatchSurface& s, const MatrixXd& C, const PointMap& rows,
                        int threads) {
  const JointEmbedding joint =
      joint_embedding(s.vectors.leftCols(C.rows()), s.vectors.leftCols(C.rows()), {C, C});
  if (rows.empty()) return nearest_rows(joint.a, joint.b, threads);
  return nearest_rows(joint.a(rows, Eigen::all), joint.b, threads);
}

void refine(const MatchSurface& s, Rival& rival) {
  const auto count = std::min<Index>(detail::kVertexSamples, static_cast<Index>(s.samples.size()));
  const PointMap samples(s.samples.begin(), s.samples.begin() + count);
  const Eigen::VectorXd even = Eigen::VectorXd::Ones(count);
  const auto leading = [&](int size) {
    return Eigen::seqN(0, std::min<Index>(size, s.vectors.cols()));
  };
  for (const int size : detail::kVertexSizes) {
    const PointMap images = nearest_images(s, rival.C, samples, 1);
    rival.C = symmetric_part(fit_functional_map(s.vectors(samples, leading(size)), even,
                                                s.vectors(images, leading(size))));
  }
  for (const int size : kDenseSizes) {
    const PointMap images = nearest_images(s, rival.C, {}, 1);
    const MatrixXd weighted = s.mass.asDiagonal() * s.vectors(Eigen::all, leading(size));
    rival.C = symmetric_part(product_at_b(weighted, s.vectors(images, leading(size))));
  }
  rival.points = nearest_images(s, rival.C, {}, 1);
}

// Distance from x to its image: as far apart as the samples see them. A lower bound,
// tight with hundreds of samples.
double mean_displacement(const MatchSurface& s, const PointMap& map) {
  const RowMatrixXf moved = s.distances(Eigen::all, map);
  const Eigen::VectorXf seen = (s.distances - moved).cwiseAbs().colwise().maxCoeff().transpose();
  return s.mass.dot(seen.cast<double>());
}

PointMap twice(const PointMap& map) {
  PointMap result(map.size());
  for (std::size_t i = 0; i < map.size(); ++i) result[i] = map[static_cast<std::size_t>(map[i])];
  return result;
}

// Geodesic distances cannot tell a front-to-back map, which moves every point a little
// and keeps distances on thin limbs. At high frequency it misses the eigenfunctions, and
// a shape posed by it does not fit itself. That a reflection exchanges limbs is a prior,
// and must stay a weak one.
double energy_of(const MatchSurface& s, const Rival& rival) {
  constexpr Index kSize = 100;
  const PosedSurface posed = pose_as(s, s, rival.points, kSize, -1);
  const Points image = s.points(rival.points, Eigen::all);
  const Points normals = s.normals(rival.points, Eigen::all);
  const double misfit = std::sqrt(s.mass.dot((posed.points - image).rowwise().squaredNorm()));
  const double agreement = s.mass.dot(posed.normals.cwiseProduct(normals).rowwise().sum());
  return commutation_error(s, s, rival.C, kSize) + 5.0 * misfit - 0.2 * rival.displacement -
         0.1 * agreement;
}

}  // namespace

std::vector<Reflection> find_reflections(const MatchSurface& shape,
                                         const SymmetryOptions& options) {
  detail::require_at_least("candidates", options.candidates, 1);
  detail::require_at_least("rivals", options.rivals, 1);
  const SingleThreadedBlas blas;
  ProgressReporter reporter(options.progress, "symmetry", 3);
  const std::vector<Candidate> candidates = search(shape, options);
  reporter.advance();
  std::vector<Rival> rivals = compare_on_samples(shape, candidates, options);
  reporter.advance();
  parallel_for(static_cast<std::int64_t>(rivals.size()), options.threads, [&](std::int64_t i) {
    Rival& rival = rivals[static_cast<std::size_t>(i)];
    refine(shape, rival);
    rival.displacement = mean_displacement(shape, rival.points);
    rival.involution = mean_displacement(shape, twice(rival.points));
    rival.energy = energy_of(shape, rival);
  });
  reporter.advance();
  std::erase_if(rivals, [](const Rival& rival) {
    return rival.energies.geodesic > kStretched || rival.displacement < detail::kDistinct;
  });
  std::stable_sort(rivals.begin(), rivals.end(),
                   [](const Rival& x, const Rival& y) { return x.energy < y.energy; });

  std::vector<Reflection> reflections;
  double total = 0.0;
  for (Rival& rival : rivals) {
    Reflection found;
    found.map = between_files(shape, shape, rival.points);
    found.C = std::move(rival.C);
    found.energy = rival.energy;
    found.confidence = std::exp((rivals[0].energy - rival.energy) / kEnergyScale);
    found.displacement = rival.displacement;
    found.involution = rival.involution;
    found.energies = rival.energies;
    total += found.confidence;
    reflections.push_back(std::move(found));
  }
  for (Reflection& found : reflections) found.confidence /= total;
  return reflections;
}

}  // namespace timbre

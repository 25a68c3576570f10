#include "timbre/analysis/spectrum/spectrum.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/huge_pages.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/analysis/spectrum/detail/merged_pairs.h"

namespace timbre {

using Eigen::Index;
using Eigen::MatrixXd;

Spectrum compute_spectrum(const Operator& op, const SpectrumOptions& options) {
  const SingleThreadedBlas blas;
  detail::MergedPairs merged(op, options);
  MatrixXd vectors(op.stiffness.rows(), merged.wanted());
  prefer_huge_pages(vectors.data(), static_cast<std::size_t>(vectors.size()) * sizeof(double));
  Index column = 0;
  for (;;) {
    const std::vector<detail::MergedPair> band = merged.next();
    if (band.empty()) break;
    for (const detail::MergedPair& pair : band) {
      merged.write_vector(pair, vectors.col(column++).data());
    }
  }
  Spectrum found = merged.finish();
  found.vectors = std::move(vectors);
  return found;
}

Spectrum at_unit_area(Spectrum spectrum, double area) {
  spectrum.values *= area;
  spectrum.vectors *= std::sqrt(area);
  if (spectrum.certificate) {
    spectrum.certificate->bound *= area;
    for (InertiaCount& count : spectrum.certificate->shifts) count.shift *= area;
  }
  return spectrum;
}

Spectrum at_vertices(Spectrum spectrum, const Operator& op) {
  if (spectrum.vectors.rows() > op.vertices) {
    spectrum.vectors = MatrixXd(spectrum.vectors.topRows(op.vertices));
  }
  return spectrum;
}

}  // namespace timbre

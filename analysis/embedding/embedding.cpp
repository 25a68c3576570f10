#include "timbre/analysis/embedding/embedding.h"

#include <algorithm>

#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

Eigen::ArrayXd weights(const Eigen::ArrayXd& values, const EmbeddingOptions& options) {
  switch (options.kind) {
    case EmbeddingKind::diffusion:
      return (-options.time * values).exp();
    case EmbeddingKind::biharmonic:
      return values.inverse();
    case EmbeddingKind::gps:
      break;
  }
  return values.rsqrt();
}

}  // namespace

Eigen::MatrixXd compute_embedding(const Spectrum& spectrum, const EmbeddingOptions& options) {
  if (options.dimensions < 0 || !(options.time > 0.0)) {
    throw Error(ErrorKind::bad_request, "", "embedding",
                "needs dimensions of at least 0 and a positive time");
  }
  Eigen::Index dimensions = spectrum.values.size() - spectrum.zeros;
  if (options.dimensions > 0) dimensions = std::min<Eigen::Index>(dimensions, options.dimensions);
  if (dimensions < 1) {
    throw Error(ErrorKind::bad_request, "", "spectrum",
                "holds no eigenvalue above zero; ask for more eigenpairs");
  }
  const Eigen::ArrayXd values = spectrum.values.segment(spectrum.zeros, dimensions);
  return spectrum.vectors.middleCols(spectrum.zeros, dimensions) *
         weights(values, options).matrix().asDiagonal();
}

}  // namespace timbre

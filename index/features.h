#pragma once

#include <string>

#include "timbre/analysis/core/progress.h"
#include "timbre/index/channel.h"
#include "timbre/index/store.h"

namespace timbre {

/// Solves one mesh as the shapes of a database are solved.
/// @param threads  that work on it, if it is large; 0: all cores
/// @throws Error  what `compute_operator` and `compute_spectrum` throw
[[nodiscard]] ShapeFeatures compute_features(TriangleMesh mesh, const StoreParameters& parameters,
                                             const Progress& progress = {}, int threads = 0);

/// All that is stored of a mesh: eigenvalues and the descriptors of all channels.
[[nodiscard]] ShapeRecord compute_record(std::string name, std::string label, TriangleMesh mesh,
                                         const StoreParameters& parameters,
                                         const Progress& progress = {}, int threads = 0);

}  // namespace timbre

#include "timbre/index/features.h"

#include <utility>

namespace timbre {

ShapeFeatures compute_features(TriangleMesh mesh, const StoreParameters& parameters,
                               const Progress& progress, int threads) {
  Operator op = compute_operator(mesh, {.kind = parameters.operator_kind, .mass = parameters.mass});
  Spectrum spectrum =
      compute_spectrum(op, {.count = parameters.count, .threads = threads, .progress = progress});
  return {at_unit_area(at_vertices(std::move(spectrum), op), op.area), op.area, std::move(mesh),
          op.lumped_mass.head(op.vertices)};
}

ShapeRecord compute_record(std::string name, std::string label, TriangleMesh mesh,
                           const StoreParameters& parameters, const Progress& progress,
                           int threads) {
  ShapeFeatures features = compute_features(std::move(mesh), parameters, progress, threads);
  ShapeRecord record;
  record.name = std::move(name);
  record.label = std::move(label);
  record.area = features.area;
  record.eigenvalues = features.spectrum.values;
  for (const Channel& channel : channels()) {
    record.descriptors.push_back(
        {channel.name, channel.version, channel.parameters, channel.compute(features)});
  }
  record.mesh = std::move(features.mesh);
  return record;
}

}  // namespace timbre

#pragma once

#include <random>
#include <string>

#include "timbre/index/channel.h"
#include "timbre/index/store.h"

namespace timbre {

/// A record with made-up content that differs with `seed`; nothing is solved.
inline ShapeRecord sample_record(const std::string& name, unsigned seed, Eigen::Index vertices = 40,
                                 const std::string& label = "") {
  std::mt19937 draw(seed);
  std::normal_distribution<double> normal;
  ShapeRecord record;
  record.name = name;
  record.label = label;
  record.area = 1.0 + static_cast<double>(seed);
  record.mesh.vertices.resize(vertices, 3);
  for (double& x : record.mesh.vertices.reshaped()) x = normal(draw);
  record.mesh.faces.resize(vertices - 2, 3);
  for (Eigen::Index f = 0; f < vertices - 2; ++f) {
    const auto i = static_cast<std::int32_t>(f);
    record.mesh.faces.row(f) << 0, i + 1, i + 2;
  }
  record.eigenvalues = Eigen::VectorXd::LinSpaced(30, 0.0, 100.0 + seed);
  for (const Channel& channel : channels()) {
    Eigen::VectorXd values(20);
    for (double& x : values) x = normal(draw);
    record.descriptors.push_back({channel.name, channel.version, channel.parameters, values});
  }
  return record;
}

}  // namespace timbre

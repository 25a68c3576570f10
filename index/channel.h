#pragma once

#include <Eigen/Core>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre {

/// What descriptors are computed from: one shape, solved once.
struct ShapeFeatures {
  Spectrum spectrum;       ///< at unit total area
  double area = 0.0;       ///< true total area, length^2
  TriangleMesh mesh;       ///< at its own scale
  Eigen::VectorXd masses;  ///< n, area around each vertex, length^2
};

/// Names and values that decide what a stored number means.
using Parameters = std::map<std::string, std::string>;

/// `count=100 form=weyl`: sorted by key, one spelling for one meaning.
[[nodiscard]] std::string canonical_text(const Parameters& parameters);

/// One way to describe a shape by a vector, and to compare two.
///
/// A new channel is one file in `channels/` and one line in `channel.cpp`; data stored
/// for other channels stay as they are. A change of what `compute` returns needs a new
/// version or other parameters: databases refuse to mix them.
///
/// A mesh with few vertices has few eigenvalues and so may have a shorter vector than
/// others. Distances compare the leading entries that both have; with none in common
/// the distance is infinite.
struct Channel {
  std::string name;
  int version = 1;
  Parameters parameters;  ///< its own; those of the database are added on storing
  Eigen::VectorXd (*compute)(const ShapeFeatures& features) = nullptr;
  double (*distance)(std::span<const double> a, std::span<const double> b) = nullptr;
};

/// All channels this build knows, by name.
[[nodiscard]] const std::vector<Channel>& channels();

/// @throws Error  bad_request for an unknown name, with the names there are
[[nodiscard]] const Channel& find_channel(const std::string& name);

/// The channel of queries that name none.
inline constexpr char kDefaultChannel[] = "dna_weyl";

/// Mean of |a_i - b_i| over the leading entries both have.
[[nodiscard]] double mean_absolute_difference(std::span<const double> a, std::span<const double> b);
/// Square root of the sum of (a_i - b_i)^2 over the leading entries both have.
[[nodiscard]] double euclidean_distance(std::span<const double> a, std::span<const double> b);

}  // namespace timbre

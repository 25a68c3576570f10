#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "timbre/analysis/mesh/diagnosis.h"
#include "timbre/analysis/mesh/read_mesh.h"

namespace timbre::cli {

/// What can be marked on a picture of a mesh.
enum class Defect : std::uint8_t {
  boundary,
  nonmanifold_edge,
  nonmanifold_vertex,
  flipped_edge,
  degenerate_face,
  thin_face,
  duplicate_face,
  coincident_vertex,
};

/// Something that was found, how often and where, and what it means for the spectrum.
struct MeshFinding {
  std::string what;
  std::int64_t count = 0;  ///< 0: there is nothing to count
  std::string places;      ///< the first few, or empty
  std::string consequence;
  std::optional<Defect> defect = {};
};

[[nodiscard]] std::vector<MeshFinding> findings_of(const Diagnosis& found);

/// Whether the findings say what this warning of the reader says, with its consequence.
[[nodiscard]] bool is_in_findings(const ReadWarning& warning);

/// Components, boundary, genus: what kind of surface it is, in a line.
[[nodiscard]] std::string describe_surface(const Diagnosis& found);

/// Lengths and angles of the triangles, in a line.
[[nodiscard]] std::string describe_triangles(const Diagnosis& found);

/// `1 vertex`, `5 vertices`.
[[nodiscard]] std::string counted(std::int64_t count, const std::string& one,
                                  const std::string& many);

}  // namespace timbre::cli

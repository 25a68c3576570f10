#include "timbre/datasets/detail/creature_checks.h"

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/orientation.h"
#include "timbre/analysis/operators/operator.h"

namespace timbre::detail {

void require_possible_count(int vertices) {
  if (vertices >= 1000 && vertices <= 50000) return;
  throw Error(ErrorKind::bad_request, "", "vertices",
              std::to_string(vertices) + " asked for; 1000 to 50000 are possible");
}

bool is_sphere(const TriangleMesh& mesh) {
  const Eigen::Index edges = mesh.faces.rows() * 3 / 2;
  return mesh.vertices.rows() - edges + mesh.faces.rows() == 2 &&
         orient_outward(mesh).orientation == Orientation::outward &&
         compute_operator(mesh).component_area.size() == 1;
}

void refuse_count(int vertices, const std::string& species) {
  throw Error(ErrorKind::bad_input, "", "vertices",
              std::to_string(vertices) + " are too few for the thin parts of '" + species + "'");
}

}  // namespace timbre::detail

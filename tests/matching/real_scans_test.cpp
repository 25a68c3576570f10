#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "timbre/analysis/geodesic/graph.h"
#include "timbre/analysis/mesh/read_mesh.h"
#include "timbre/matching/match.h"
#include "timbre/tests/support/shared_data.h"

namespace timbre {
namespace {

// Line i: the 1-based vertex for template point i.
std::vector<std::int32_t> read_truth(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::vector<std::int32_t> vertices;
  for (std::int32_t v = 0; in >> v;) vertices.push_back(v - 1);
  return vertices;
}

// Mean geodesic distance to the truth over some template points, x 100 at unit area.
double map_error(const PointMap& map, const MatchSurface& target,
                 const std::vector<std::int32_t>& from, const std::vector<std::int32_t>& to) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < from.size(); i += 50) {
    const Eigen::VectorXd distance = graph_distances(target.graph, {to[i]});
    sum += distance[map[static_cast<std::size_t>(from[i])]];
    ++count;
  }
  return 100.0 * sum / count;
}

TEST(MatchOfRealScans, MapsOnePersonOntoAnotherInAnotherPose) {
  TIMBRE_NEEDS_SHARED_DATA("correspondence/faust_r");
  const std::filesystem::path folder = shared_data() / "correspondence" / "faust_r";
  const MatchSurface A = prepare_surface(read_mesh((folder / "tr_reg_020.ply").string()).mesh);
  const MatchSurface B = prepare_surface(read_mesh((folder / "tr_reg_015.ply").string()).mesh);
  const MatchResult result = match(A, B);
  EXPECT_EQ(result.verdict, Verdict::clear) << result.reason;
  EXPECT_LT(map_error(result.ab, B, read_truth(folder / "tr_reg_020.vts"),
                      read_truth(folder / "tr_reg_015.vts")),
            2.5);
}

}  // namespace
}  // namespace timbre

#include "timbre/analysis/geodesic/graph.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <string>
#include <tuple>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/analysis/mesh/sides.h"

namespace timbre {
namespace {

using Eigen::Index;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Link {
  std::int32_t from = 0;
  std::int32_t to = 0;
  double length = 0.0;
};

// Lays two triangles on a common edge into the plane, the edge on the x axis. The line
// between their apexes counts only where it crosses the edge.
double unfolded_diagonal(const Points& points, const TriangleSide& s, const TriangleSide& t) {
  const Eigen::RowVector3d a = points.row(s.low);
  const Eigen::RowVector3d edge = points.row(s.high) - a;
  const double base = edge.norm();
  if (base == 0.0) return kInfinity;
  const auto lay_down = [&](std::int32_t apex) {
    const Eigen::RowVector3d arm = points.row(apex) - a;
    const double x = arm.dot(edge) / base;
    return std::pair(x, std::sqrt(std::max(arm.squaredNorm() - x * x, 0.0)));
  };
  const auto [px, py] = lay_down(s.apex);
  const auto [qx, qy] = lay_down(t.apex);
  const double height = py + qy;
  if (height == 0.0) return kInfinity;
  const double crossing = px + py / height * (qx - px);
  if (crossing <= 0.0 || crossing >= base) return kInfinity;
  return std::hypot(px - qx, height);
}

// Where more triangles meet, pairs would grow with the square of their number.
constexpr std::size_t kMostSheets = 16;

std::vector<Link> links_of(const TriangleMesh& mesh) {
  const std::vector<TriangleSide> sides = sorted_sides(mesh.faces);
  std::vector<Link> links;
  links.reserve(4 * sides.size());
  const auto join = [&](std::int32_t a, std::int32_t b, double length) {
    if (a == b || !std::isfinite(length)) return;
    links.push_back({a, b, length});
    links.push_back({b, a, length});
  };
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    const TriangleSide& edge = sides[begin];
    end = end_of_edge(sides, begin);
    join(edge.low, edge.high, (mesh.vertices.row(edge.low) - mesh.vertices.row(edge.high)).norm());
    if (end - begin > kMostSheets) continue;
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t j = i + 1; j < end; ++j) {
        join(sides[i].apex, sides[j].apex, unfolded_diagonal(mesh.vertices, sides[i], sides[j]));
      }
    }
  }
  std::sort(links.begin(), links.end(), [](const Link& a, const Link& b) {
    return std::tie(a.from, a.to, a.length) < std::tie(b.from, b.to, b.length);
  });
  const auto same_ends = [](const Link& a, const Link& b) {
    return a.from == b.from && a.to == b.to;
  };
  links.erase(std::unique(links.begin(), links.end(), same_ends), links.end());
  return links;
}

using Entry = std::pair<double, std::int32_t>;
using Queue = std::priority_queue<Entry, std::vector<Entry>, std::greater<>>;

// Lowers `distance` to what can be reached from the queue; vertices that are nearer
// already stop the spread.
void spread(const GeodesicGraph& graph, Queue& queue, Eigen::VectorXd& distance) {
  while (!queue.empty()) {
    const auto [reached, v] = queue.top();
    queue.pop();
    if (reached > distance[v]) continue;
    const auto at = static_cast<std::size_t>(v);
    for (auto e = static_cast<std::size_t>(graph.start[at]);
         e < static_cast<std::size_t>(graph.start[at + 1]); ++e) {
      const double through = reached + graph.length[e];
      const std::int32_t to = graph.neighbour[e];
      if (through >= distance[to]) continue;
      distance[to] = through;
      queue.emplace(through, to);
    }
  }
}

void lower_from(const GeodesicGraph& graph, std::int32_t source, Eigen::VectorXd& distance) {
  Queue queue;
  distance[source] = 0.0;
  queue.emplace(0.0, source);
  spread(graph, queue, distance);
}

void require_vertex(const GeodesicGraph& graph, std::int32_t source) {
  if (source >= 0 && source < graph.size()) return;
  throw Error(ErrorKind::bad_request, "", "sources",
              "vertex " + std::to_string(source) + " does not exist; the mesh has " +
                  std::to_string(graph.size()));
}

}  // namespace

GeodesicGraph make_geodesic_graph(const TriangleMesh& mesh) {
  const std::vector<Link> links = links_of(mesh);
  GeodesicGraph graph;
  graph.start.assign(static_cast<std::size_t>(mesh.vertices.rows()) + 1, 0);
  graph.neighbour.reserve(links.size());
  graph.length.reserve(links.size());
  for (const Link& link : links) {
    ++graph.start[static_cast<std::size_t>(link.from) + 1];
    graph.neighbour.push_back(link.to);
    graph.length.push_back(link.length);
  }
  for (std::size_t v = 1; v < graph.start.size(); ++v) graph.start[v] += graph.start[v - 1];
  return graph;
}

Eigen::VectorXd graph_distances(const GeodesicGraph& graph,
                                const std::vector<std::int32_t>& sources) {
  Eigen::VectorXd distance = Eigen::VectorXd::Constant(graph.size(), kInfinity);
  Queue queue;
  for (const std::int32_t source : sources) {
    require_vertex(graph, source);
    distance[source] = 0.0;
    queue.emplace(0.0, source);
  }
  spread(graph, queue, distance);
  return distance;
}

RowMatrixXf graph_distance_rows(const GeodesicGraph& graph,
                                const std::vector<std::int32_t>& sources, int threads) {
  RowMatrixXf rows(static_cast<Index>(sources.size()), graph.size());
  parallel_for(rows.rows(), threads, [&](std::int64_t i) {
    rows.row(i) = graph_distances(graph, {sources[static_cast<std::size_t>(i)]}).cast<float>();
  });
  return rows;
}

std::vector<std::int32_t> geodesic_farthest_points(const GeodesicGraph& graph, Index count,
                                                   std::int32_t first) {
  require_vertex(graph, first);
  std::vector<std::int32_t> points;
  Eigen::VectorXd distance = Eigen::VectorXd::Constant(graph.size(), kInfinity);
  count = std::min(count, graph.size());
  Index next = first;
  while (static_cast<Index>(points.size()) < count) {
    points.push_back(static_cast<std::int32_t>(next));
    lower_from(graph, points.back(), distance);
    distance[next] = -1.0;  // never again, not even among coincident vertices
    distance.maxCoeff(&next);
  }
  return points;
}

}  // namespace timbre

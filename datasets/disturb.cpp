#include "timbre/datasets/disturb.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/geodesic/graph.h"
#include "timbre/analysis/operators/operator.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::RowVector3d;
using Eigen::VectorXd;

VectorXd face_areas(const TriangleMesh& mesh) {
  VectorXd areas(mesh.faces.rows());
  for (Index f = 0; f < mesh.faces.rows(); ++f) {
    const RowVector3d a = mesh.vertices.row(mesh.faces(f, 0));
    const RowVector3d u = mesh.vertices.row(mesh.faces(f, 1)) - a;
    const RowVector3d v = mesh.vertices.row(mesh.faces(f, 2)) - a;
    areas[f] = 0.5 * u.cross(v).norm();
  }
  return areas;
}

VectorXd face_means(const TriangleMesh& mesh, const VectorXd& values) {
  VectorXd means(mesh.faces.rows());
  for (Index f = 0; f < mesh.faces.rows(); ++f) {
    means[f] = (values[mesh.faces(f, 0)] + values[mesh.faces(f, 1)] + values[mesh.faces(f, 2)]) / 3;
  }
  return means;
}

double mean_edge(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (Index f = 0; f < mesh.faces.rows(); ++f) {
    for (Index c = 0; c < 3; ++c) {
      sum += (mesh.vertices.row(mesh.faces(f, c)) - mesh.vertices.row(mesh.faces(f, (c + 1) % 3)))
                 .norm();
    }
  }
  return mesh.faces.rows() == 0 ? 0.0 : sum / static_cast<double>(3 * mesh.faces.rows());
}

// The faces, least value first, until they hold `area`.
std::vector<Index> lowest_faces(const TriangleMesh& mesh, const VectorXd& values, double area) {
  const VectorXd areas = face_areas(mesh);
  std::vector<Index> order(static_cast<std::size_t>(mesh.faces.rows()));
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return values[a] < values[b]; });
  double sum = 0.0;
  std::size_t count = 0;
  while (count < order.size() && sum < area) sum += areas[order[count++]];
  order.resize(count);
  return order;
}

MeshPart with_faces(const TriangleMesh& mesh, const std::function<bool(Index)>& keep) {
  MeshPart part;
  std::vector<std::int32_t> renumbered(static_cast<std::size_t>(mesh.vertices.rows()), -1);
  std::vector<Index> faces;
  for (Index f = 0; f < mesh.faces.rows(); ++f) {
    if (!keep(f)) continue;
    faces.push_back(f);
    for (Index c = 0; c < 3; ++c) renumbered[static_cast<std::size_t>(mesh.faces(f, c))] = 0;
  }
  for (std::size_t v = 0; v < renumbered.size(); ++v) {
    if (renumbered[v] < 0) continue;
    renumbered[v] = static_cast<std::int32_t>(part.original.size());
    part.original.push_back(static_cast<std::int32_t>(v));
  }
  part.mesh.vertices = mesh.vertices(part.original, Eigen::all);
  part.mesh.faces.resize(static_cast<Index>(faces.size()), 3);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (Index c = 0; c < 3; ++c) {
      part.mesh.faces(static_cast<Index>(f), c) =
          renumbered[static_cast<std::size_t>(mesh.faces(faces[f], c))];
    }
  }
  return part;
}

MeshPart largest_component(const MeshPart& part) {
  const Operator op = compute_operator(part.mesh);
  Index largest = 0;
  op.component_area.maxCoeff(&largest);
  MeshPart kept = with_faces(part.mesh, [&](Index f) {
    return op.component[static_cast<std::size_t>(part.mesh.faces(f, 0))] == largest;
  });
  for (std::int32_t& v : kept.original) v = part.original[static_cast<std::size_t>(v)];
  return kept;
}

void require(bool holds, const char* place, const char* cause) {
  if (!holds) throw Error(ErrorKind::bad_request, "", place, cause);
}

struct Contact {
  Index one = -1;
  Index other = -1;
};

// A sample and the vertex nearest to it in space among those far from it on the surface.
Contact find_contact(const TriangleMesh& mesh) {
  constexpr Index kSamples = 200;
  const double far = 0.35 * std::sqrt(face_areas(mesh).sum());
  const GeodesicGraph graph = make_geodesic_graph(mesh);
  const std::vector<std::int32_t> samples = geodesic_farthest_points(graph, kSamples, 0);
  Contact best;
  double least = std::numeric_limits<double>::infinity();
  for (const std::int32_t from : samples) {
    const VectorXd along = graph_distances(graph, {from});
    for (Index to = 0; to < along.size(); ++to) {
      if (!(along[to] > far) || !std::isfinite(along[to])) continue;
      const double apart = (mesh.vertices.row(from) - mesh.vertices.row(to)).norm();
      if (apart >= least) continue;
      least = apart;
      best = {from, to};
    }
  }
  return best;
}

// Of the faces at a vertex the one that looks most towards a point.
Index facing(const TriangleMesh& mesh, Index vertex, const RowVector3d& point) {
  Index best = -1;
  double most = -2.0;
  for (Index f = 0; f < mesh.faces.rows(); ++f) {
    if ((mesh.faces.row(f).array() != static_cast<int>(vertex)).all()) continue;
    const RowVector3d a = mesh.vertices.row(mesh.faces(f, 0));
    const RowVector3d normal = (mesh.vertices.row(mesh.faces(f, 1)) - a)
                                   .cross(mesh.vertices.row(mesh.faces(f, 2)) - a)
                                   .normalized();
    const double view = normal.dot((point - mesh.vertices.row(vertex)).normalized());
    if (view <= most) continue;
    most = view;
    best = f;
  }
  return best;
}

}  // namespace

TriangleMesh add_noise(const TriangleMesh& mesh, double strength, Random& random) {
  require(strength >= 0.0 && std::isfinite(strength), "strength", "must be at least 0");
  TriangleMesh noisy = mesh;
  const double deviation = strength * mean_edge(mesh) / std::sqrt(3.0);
  for (Index v = 0; v < noisy.vertices.rows(); ++v) {
    for (Index c = 0; c < 3; ++c) noisy.vertices(v, c) += deviation * random.normal();
  }
  return noisy;
}

MeshPart punch_holes(const TriangleMesh& mesh, int count, double share, Random& random) {
  require(count >= 0 && share > 0.0 && count * share < 0.9, "holes",
          "must leave a tenth of the surface");
  require(mesh.faces.rows() > 0, "mesh", "has no triangles");
  const GeodesicGraph graph = make_geodesic_graph(mesh);
  const double area = share * face_areas(mesh).sum();
  std::vector<bool> gone(static_cast<std::size_t>(mesh.faces.rows()), false);
  const auto n = static_cast<double>(mesh.vertices.rows());
  for (int hole = 0; hole < count; ++hole) {
    const auto centre = static_cast<std::int32_t>(random.uniform(0.0, n));
    const VectorXd distance = face_means(mesh, graph_distances(graph, {centre}));
    for (const Index f : lowest_faces(mesh, distance, area))
      gone[static_cast<std::size_t>(f)] = true;
  }
  return largest_component(
      with_faces(mesh, [&](Index f) { return !gone[static_cast<std::size_t>(f)]; }));
}

MeshPart cut_by_plane(const TriangleMesh& mesh, double keep, Random& random) {
  require(keep >= 0.1 && keep <= 0.9, "keep", "must be between 0.1 and 0.9");
  require(mesh.faces.rows() > 0, "mesh", "has no triangles");
  const Eigen::Vector3d direction(random.normal(), random.normal(), random.normal());
  const VectorXd height = face_means(mesh, mesh.vertices * direction);
  std::vector<bool> kept(static_cast<std::size_t>(mesh.faces.rows()), false);
  for (const Index f : lowest_faces(mesh, height, keep * face_areas(mesh).sum())) {
    kept[static_cast<std::size_t>(f)] = true;
  }
  return largest_component(
      with_faces(mesh, [&](Index f) { return kept[static_cast<std::size_t>(f)]; }));
}

TriangleMesh weld_contact(const TriangleMesh& mesh) {
  const Contact contact = find_contact(mesh);
  if (contact.one < 0) {
    throw Error(ErrorKind::bad_input, "", "mesh", "no two places are far apart on the surface");
  }
  const Index near = facing(mesh, contact.one, mesh.vertices.row(contact.other));
  const Index far = facing(mesh, contact.other, mesh.vertices.row(contact.one));
  const Eigen::RowVector3i a = mesh.faces.row(near);
  const Eigen::RowVector3i b = mesh.faces.row(far);
  // Corner i of one side joins corner `turn` - i of the other; the least twisted of three.
  const auto opposite = [&](int i, int turn) { return b[(turn - i + 6) % 3]; };
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int turn = 0; turn < 3; ++turn) {
    double length = 0.0;
    for (int i = 0; i < 3; ++i) {
      length += (mesh.vertices.row(a[i]) - mesh.vertices.row(opposite(i, turn))).norm();
    }
    if (length >= least) continue;
    least = length;
    best = turn;
  }
  TriangleMesh welded = mesh;
  welded.faces.conservativeResize(mesh.faces.rows() + 4, 3);
  // Two triangles for each side of the bridge: in place of the two that go, and behind the last.
  const Index last = mesh.faces.rows();
  const std::array<std::array<Index, 2>, 3> rows = {
      {{near, far}, {last, last + 1}, {last + 2, last + 3}}};
  for (int i = 0; i < 3; ++i) {
    const auto& [first, second] = rows[static_cast<std::size_t>(i)];
    welded.faces.row(first) << a[i], a[(i + 1) % 3], opposite(i + 1, best);
    welded.faces.row(second) << a[i], opposite(i + 1, best), opposite(i, best);
  }
  return welded;
}

}  // namespace timbre

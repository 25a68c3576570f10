#include "timbre/analysis/mesh/half_edge.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <algorithm>
#include <string>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/diagnosis.h"

namespace timbre {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

[[noreturn]] void refuse(const std::string& place, const std::string& cause) {
  throw Error(ErrorKind::bad_input, "", place, cause + "; half-edges need a manifold mesh");
}

std::string name_of(const std::array<std::int32_t, 2>& edge) {
  return "edge " + std::to_string(edge[0]) + "-" + std::to_string(edge[1]);
}

// OpenMesh drops or splits what it cannot hold, so it must not see any of it.
void require_manifold(const TriangleMesh& mesh) {
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    const auto corner = mesh.faces.row(f);
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) {
      refuse("face " + std::to_string(f), "a corner is repeated");
    }
  }
  const Diagnosis found = diagnose(mesh);
  if (found.nonmanifold_edges > 0) {
    refuse(name_of(found.first_nonmanifold_edges.front()), "three or more triangles share it");
  }
  if (found.nonmanifold_vertices > 0) {
    refuse("vertex " + std::to_string(found.first_nonmanifold_vertices.front()),
           "its triangles form more than one fan");
  }
  if (found.flipped_edges > 0) {
    refuse(name_of(found.first_flipped_edges.front()), "its two triangles are turned unlike");
  }
}

// Positions in units of the bounding box: decimation keeps errors in single precision.
Mesh to_open_mesh(const TriangleMesh& mesh) {
  require_manifold(mesh);
  Mesh out;
  out.reserve(static_cast<std::size_t>(mesh.vertices.rows()), 0,
              static_cast<std::size_t>(mesh.faces.rows()));
  if (mesh.vertices.rows() == 0) return out;
  const Eigen::RowVector3d low = mesh.vertices.colwise().minCoeff();
  const double size = (mesh.vertices.colwise().maxCoeff() - low).maxCoeff();
  const double scale = size > 0.0 ? size : 1.0;
  for (Eigen::Index i = 0; i < mesh.vertices.rows(); ++i) {
    const Eigen::RowVector3d p = (mesh.vertices.row(i) - low) / scale;
    out.add_vertex({p[0], p[1], p[2]});
  }
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    const auto corner = mesh.faces.row(f);
    const auto face = out.add_face(Mesh::VertexHandle(corner[0]), Mesh::VertexHandle(corner[1]),
                                   Mesh::VertexHandle(corner[2]));
    if (!face.is_valid()) refuse("face " + std::to_string(f), "OpenMesh cannot add it");
  }
  return out;
}

}  // namespace

struct HalfEdgeMesh::Impl {
  Mesh mesh;
};

HalfEdgeMesh::HalfEdgeMesh(const TriangleMesh& mesh)
    : impl_(std::make_unique<Impl>(Impl{to_open_mesh(mesh)})) {}
HalfEdgeMesh::~HalfEdgeMesh() = default;
HalfEdgeMesh::HalfEdgeMesh(HalfEdgeMesh&&) noexcept = default;
HalfEdgeMesh& HalfEdgeMesh::operator=(HalfEdgeMesh&&) noexcept = default;

std::vector<std::vector<std::int32_t>> HalfEdgeMesh::boundary_loops() const {
  const Mesh& mesh = impl_->mesh;
  std::vector<bool> seen(mesh.n_vertices(), false);
  std::vector<std::vector<std::int32_t>> loops;
  for (const auto start : mesh.vertices()) {
    if (seen[static_cast<std::size_t>(start.idx())] || !start.halfedge().is_valid() ||
        !start.is_boundary()) {
      continue;
    }
    std::vector<std::int32_t>& loop = loops.emplace_back();
    // A boundary half-edge has the hole on its left, so the surface is walked backwards.
    for (auto edge = start.halfedge(); loop.empty() || edge.from() != start; edge = edge.prev()) {
      loop.push_back(edge.from().idx());
      seen[static_cast<std::size_t>(edge.from().idx())] = true;
    }
  }
  return loops;
}

std::vector<std::int32_t> HalfEdgeMesh::one_ring(std::int32_t vertex) const {
  std::vector<std::int32_t> ring;
  const Mesh& mesh = impl_->mesh;
  if (vertex < 0 || static_cast<std::size_t>(vertex) >= mesh.n_vertices()) {
    throw Error(ErrorKind::bad_request, "", "vertex " + std::to_string(vertex),
                "the mesh has " + std::to_string(mesh.n_vertices()) + " vertices");
  }
  // Clockwise from the half-edge of the vertex, which on a boundary is the boundary's.
  const auto first = OpenMesh::make_smart(Mesh::VertexHandle(vertex), mesh).halfedge();
  if (!first.is_valid()) return ring;
  auto edge = first;
  do {
    ring.push_back(edge.to().idx());
    edge = edge.opp().next();
  } while (edge != first);
  std::reverse(ring.begin(), ring.end());
  return ring;
}

DecimatedMesh decimate(const TriangleMesh& mesh, std::int32_t target) {
  if (target < 4) {
    throw Error(ErrorKind::bad_request, "", "target",
                "asks for " + std::to_string(target) + " vertices; at least 4 are needed");
  }
  Mesh work = to_open_mesh(mesh);
  work.request_vertex_status();
  work.request_edge_status();
  work.request_halfedge_status();
  work.request_face_status();
  work.request_face_normals();
  work.update_face_normals();
  std::int64_t used = 0;
  for (const auto vertex : work.all_vertices()) {
    const bool is_used = vertex.halfedge().is_valid();
    work.status(vertex).set_deleted(!is_used);
    if (is_used) ++used;
  }
  if (used > target) {
    OpenMesh::Decimater::DecimaterT<Mesh> decimater(work);
    OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
    OpenMesh::Decimater::ModNormalFlippingT<Mesh>::Handle flipping;
    decimater.add(quadric);
    decimater.add(flipping);
    decimater.initialize();
    decimater.decimate(static_cast<std::size_t>(used - target));
  }

  DecimatedMesh result;
  std::vector<std::int32_t> number(work.n_vertices(), -1);
  for (const auto vertex : work.vertices()) {  // those that are left
    number[static_cast<std::size_t>(vertex.idx())] =
        static_cast<std::int32_t>(result.original.size());
    result.original.push_back(vertex.idx());
  }
  result.mesh.vertices = mesh.vertices(result.original, Eigen::all);
  std::vector<std::int32_t> corners;
  for (const auto face : work.faces()) {
    for (const auto vertex : face.vertices()) {
      corners.push_back(number[static_cast<std::size_t>(vertex.idx())]);
    }
  }
  result.mesh.faces = Eigen::Map<const Faces>(corners.data(), std::ssize(corners) / 3, 3);
  return result;
}

}  // namespace timbre

#include <Eigen/Geometry>

#include "timbre/analysis/mesh/detail/append_number.h"
#include "timbre/analysis/mesh/detail/writers.h"

namespace timbre::detail {
namespace {

void append_point(std::string& out, const Eigen::RowVector3d& point) {
  for (const double c : point) append_little_endian(out, static_cast<float>(c));
}

}  // namespace

std::string stl_bytes(const TriangleMesh& mesh) {
  constexpr std::size_t kHeader = 80;
  constexpr std::size_t kFacet = 50;
  if (mesh.faces.rows() == 0) {
    throw Error(ErrorKind::bad_request, "", "output",
                "a mesh without faces is nothing that .stl holds; .ply keeps it");
  }
  const Points rounded = mesh.vertices.unaryExpr([](double c) { return double{to_float(c)}; });
  std::string out = "created by timbre";  // never `solid`, which is the text's first word
  out.reserve(kHeader + sizeof(std::uint32_t) +
              kFacet * static_cast<std::size_t>(mesh.faces.rows()));
  out.resize(kHeader, ' ');
  append_little_endian(out, static_cast<std::uint32_t>(mesh.faces.rows()));
  for (const auto& face : mesh.faces.rowwise()) {
    const Eigen::RowVector3d a = rounded.row(face[0]);
    const Eigen::RowVector3d b = rounded.row(face[1]);
    const Eigen::RowVector3d c = rounded.row(face[2]);
    append_point(out, (b - a).cross(c - a).normalized());  // 0 0 0 where there is no area
    append_point(out, a);
    append_point(out, b);
    append_point(out, c);
    append_little_endian(out, std::uint16_t{0});
  }
  return out;
}

}  // namespace timbre::detail

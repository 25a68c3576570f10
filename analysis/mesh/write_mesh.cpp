#include "timbre/analysis/mesh/write_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <string_view>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/output_file.h"
#include "timbre/analysis/mesh/detail/append_number.h"
#include "timbre/analysis/mesh/detail/writers.h"

namespace timbre {
namespace {

using detail::append_big_endian;
using detail::append_text;
using detail::to_float;

static_assert(std::endian::native == std::endian::little, "PLY bodies are copied as they lie");

// FreeSurfer's surfaces have no ending but their name: lh.white.
constexpr std::array<std::string_view, 7> kFreesurferEndings = {
    ".white", ".pial", ".inflated", ".sphere", ".orig", ".smoothwm", ".surf"};

// `a b c` for each row, each number raised by `offset`.
template <typename Table>
void append_rows(std::string& out, const Table& table, std::string_view before,
                 typename Table::Scalar offset, std::string_view after = {}) {
  for (Eigen::Index i = 0; i < table.rows(); ++i) {
    out += before;
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (k > 0) out += ' ';
      append_text(out, offset == 0 ? table(i, k) : table(i, k) + offset);
    }
    out += after;
    out += '\n';
  }
}

std::string off_bytes(const TriangleMesh& mesh) {
  std::string out = "OFF\n" + std::to_string(mesh.vertices.rows()) + " " +
                    std::to_string(mesh.faces.rows()) + " 0\n";
  append_rows(out, mesh.vertices, "", 0.0);
  append_rows(out, mesh.faces, "3 ", 0);
  return out;
}

std::string obj_bytes(const TriangleMesh& mesh) {
  std::string out;
  append_rows(out, mesh.vertices, "v ", 0.0);
  append_rows(out, mesh.faces, "f ", 1);
  return out;
}

std::string ply_bytes(const TriangleMesh& mesh) {
  std::string out =
      "ply\nformat binary_little_endian 1.0\n"
      "element vertex " +
      std::to_string(mesh.vertices.rows()) +
      "\nproperty double x\nproperty double y\nproperty double z\n"
      "element face " +
      std::to_string(mesh.faces.rows()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto vertex_bytes = static_cast<std::size_t>(mesh.vertices.size()) * sizeof(double);
  constexpr std::size_t kRow = 3 * sizeof(std::int32_t);
  out.reserve(out.size() + vertex_bytes + static_cast<std::size_t>(mesh.faces.rows()) * (kRow + 1));
  if (vertex_bytes > 0)
    out.append(reinterpret_cast<const char*>(mesh.vertices.data()), vertex_bytes);
  for (Eigen::Index i = 0; i < mesh.faces.rows(); ++i) {
    out += '\3';
    out.append(reinterpret_cast<const char*>(mesh.faces.data() + 3 * i), kRow);
  }
  return out;
}

std::string freesurfer_bytes(const TriangleMesh& mesh) {
  std::string out =
      "\xff\xff\xfe"
      "created by timbre\n\n";
  append_big_endian(out, static_cast<std::int32_t>(mesh.vertices.rows()));
  append_big_endian(out, static_cast<std::int32_t>(mesh.faces.rows()));
  const std::span vertices(mesh.vertices.data(), static_cast<std::size_t>(mesh.vertices.size()));
  const std::span faces(mesh.faces.data(), static_cast<std::size_t>(mesh.faces.size()));
  for (const double c : vertices) append_big_endian(out, to_float(c));
  for (const std::int32_t v : faces) append_big_endian(out, v);
  return out;
}

// The layout before version 5.1, which every tool reads.
std::string vtk_bytes(const TriangleMesh& mesh) {
  std::string out =
      "# vtk DataFile Version 3.0\ncreated by timbre\nBINARY\nDATASET POLYDATA\nPOINTS " +
      std::to_string(mesh.vertices.rows()) + " double\n";
  const std::span vertices(mesh.vertices.data(), static_cast<std::size_t>(mesh.vertices.size()));
  for (const double c : vertices) append_big_endian(out, c);
  out += "\nPOLYGONS " + std::to_string(mesh.faces.rows()) + " " +
         std::to_string(4 * mesh.faces.rows()) + "\n";
  for (Eigen::Index i = 0; i < mesh.faces.rows(); ++i) {
    append_big_endian(out, std::int32_t{3});
    for (Eigen::Index k = 0; k < 3; ++k) append_big_endian(out, mesh.faces(i, k));
  }
  out += '\n';
  return out;
}

std::string freesurfer_text(const TriangleMesh& mesh) {
  std::string out = "#!ascii created by timbre\n" + std::to_string(mesh.vertices.rows()) + " " +
                    std::to_string(mesh.faces.rows()) + "\n";
  append_rows(out, mesh.vertices, "", 0.0, " 0");
  append_rows(out, mesh.faces, "", 0, " 0");
  return out;
}

}  // namespace

MeshFormat mesh_format_of(const std::string& path) {
  std::string ending = path.substr(std::min(path.rfind('.'), path.size()));
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  if (ending == ".off") return MeshFormat::off;
  if (ending == ".obj") return MeshFormat::obj;
  if (ending == ".ply") return MeshFormat::ply;
  if (ending == ".vtk") return MeshFormat::vtk;
  if (ending == ".glb") return MeshFormat::glb;
  if (ending == ".stl") return MeshFormat::stl;
  if (ending == ".asc") return MeshFormat::freesurfer_text;
  for (const std::string_view name : kFreesurferEndings) {
    if (ending == name) return MeshFormat::freesurfer;
  }
  throw Error(
      ErrorKind::bad_request, path, "output",
      "the ending tells the format; .off, .obj, .ply, .vtk, .glb, .stl, .asc and FreeSurfer's "
      ".white, .pial, .inflated, .sphere, .orig, .smoothwm, .surf can be written");
}

std::string to_mesh_bytes(const TriangleMesh& mesh, MeshFormat format) {
  switch (format) {
    case MeshFormat::off:
      return off_bytes(mesh);
    case MeshFormat::obj:
      return obj_bytes(mesh);
    case MeshFormat::vtk:
      return vtk_bytes(mesh);
    case MeshFormat::glb:
      return detail::glb_bytes(mesh);
    case MeshFormat::stl:
      return detail::stl_bytes(mesh);
    case MeshFormat::freesurfer:
      return freesurfer_bytes(mesh);
    case MeshFormat::freesurfer_text:
      return freesurfer_text(mesh);
    default:
      return ply_bytes(mesh);
  }
}

void write_mesh(const TriangleMesh& mesh, const std::string& path, bool overwrite) {
  write_file(path, to_mesh_bytes(mesh, mesh_format_of(path)), overwrite);
}

}  // namespace timbre

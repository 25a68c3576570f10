#include "timbre/analysis/mesh/write_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <string_view>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/output_file.h"

namespace timbre {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY bodies are copied as they lie");

template <typename Number>
void append(std::string& out, Number value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  out.append(buffer.data(), result.ptr);
}

// `a b c` and a line end for each row, each number raised by `offset`.
template <typename Table>
void append_rows(std::string& out, const Table& table, std::string_view before,
                 typename Table::Scalar offset) {
  for (Eigen::Index i = 0; i < table.rows(); ++i) {
    out += before;
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (k > 0) out += ' ';
      append(out, offset == 0 ? table(i, k) : table(i, k) + offset);
    }
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

MeshFormat format_of(const std::string& path) {
  std::string ending = path.substr(std::min(path.rfind('.'), path.size()));
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  if (ending == ".off") return MeshFormat::off;
  if (ending == ".obj") return MeshFormat::obj;
  if (ending == ".ply") return MeshFormat::ply;
  throw Error(ErrorKind::bad_request, path, "output",
              "the ending tells the format; .off, .obj and .ply can be written");
}

}  // namespace

std::string to_mesh_bytes(const TriangleMesh& mesh, MeshFormat format) {
  switch (format) {
    case MeshFormat::off:
      return off_bytes(mesh);
    case MeshFormat::obj:
      return obj_bytes(mesh);
    default:
      return ply_bytes(mesh);
  }
}

void write_mesh(const TriangleMesh& mesh, const std::string& path, bool overwrite) {
  write_file(path, to_mesh_bytes(mesh, format_of(path)), overwrite);
}

}  // namespace timbre

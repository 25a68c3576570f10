#include <limits>
#include <span>
#include <string_view>

#include "timbre/analysis/mesh/detail/append_number.h"
#include "timbre/analysis/mesh/detail/writers.h"

namespace timbre::detail {
namespace {

constexpr std::int64_t kRow = 12;  // bytes of a vertex, and of a face

Error refusal(const std::string& cause) { return {ErrorKind::bad_request, "", "output", cause}; }

// `[x,y,z]`; each a float, written so that it is the same as a double.
std::string list(const Eigen::RowVector3d& numbers) {
  std::string out;
  for (const double number : numbers) {
    out += out.empty() ? '[' : ',';
    append_text(out, double{to_float(number)});
  }
  return out + ']';
}

// Numbers: 5126 is float, 5125 is unsigned int; 34962 and 34963 are vertices and indices.
std::string document(const TriangleMesh& mesh) {
  const std::string vertices = std::to_string(mesh.vertices.rows());
  const std::string corners = std::to_string(mesh.faces.size());
  const std::string vertex_bytes = std::to_string(kRow * mesh.vertices.rows());
  const std::string face_bytes = std::to_string(kRow * mesh.faces.rows());
  const std::string bytes = std::to_string(kRow * (mesh.vertices.rows() + mesh.faces.rows()));
  std::string out =
      R"({"asset":{"version":"2.0","generator":"timbre"},"scene":0,"scenes":[{"nodes":[0]}],)"
      R"("nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)" +
      vertices + R"(,"min":)" + list(mesh.vertices.colwise().minCoeff()) + R"(,"max":)" +
      list(mesh.vertices.colwise().maxCoeff()) +
      R"(},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)" + corners +
      R"(}],"bufferViews":[{"buffer":0,"byteLength":)" + vertex_bytes +
      R"(,"target":34962},{"buffer":0,"byteOffset":)" + vertex_bytes + R"(,"byteLength":)" +
      face_bytes + R"(,"target":34963}],"buffers":[{"byteLength":)" + bytes + "}]}";
  out.append((4 - out.size() % 4) % 4, ' ');
  return out;
}

void begin_chunk(std::string& out, std::size_t size, std::string_view kind) {
  append_little_endian(out, static_cast<std::uint32_t>(size));
  out += kind;
}

}  // namespace

std::uint32_t glb_body_size(std::int64_t vertices, std::int64_t faces) {
  constexpr std::int64_t kOther = 4096;  // more than headers and JSON take
  constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max() - kOther;
  if (faces == 0) throw refusal("a mesh without faces is nothing that .glb holds; .ply keeps it");
  if (vertices + faces > kMost / kRow) throw refusal("more than the 4 GiB of a .glb; use .ply");
  return static_cast<std::uint32_t>(kRow * (vertices + faces));
}

std::string glb_bytes(const TriangleMesh& mesh) {
  const std::size_t body = glb_body_size(mesh.vertices.rows(), mesh.faces.rows());
  const std::string json = document(mesh);
  const std::size_t size = 12 + 8 + json.size() + 8 + body;
  std::string out;
  out.reserve(size);
  out += "glTF";
  append_little_endian(out, std::uint32_t{2});
  append_little_endian(out, static_cast<std::uint32_t>(size));
  begin_chunk(out, json.size(), "JSON");
  out += json;
  begin_chunk(out, body, std::string_view("BIN\0", 4));
  const std::span vertices(mesh.vertices.data(), static_cast<std::size_t>(mesh.vertices.size()));
  const std::span faces(mesh.faces.data(), static_cast<std::size_t>(mesh.faces.size()));
  for (const double c : vertices) append_little_endian(out, to_float(c));
  for (const std::int32_t v : faces) append_little_endian(out, v);
  return out;
}

}  // namespace timbre::detail

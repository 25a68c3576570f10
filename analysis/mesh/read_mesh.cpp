#include "timbre/analysis/mesh/read_mesh.h"

#include <utility>

#include "timbre/analysis/core/byte_source.h"
#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/detail/assemble.h"
#include "timbre/analysis/mesh/detail/formats.h"

namespace timbre {
namespace {

using detail::Cursor;
using detail::FileFormat;
using detail::PolygonMesh;

bool ends_with_gz(std::string_view name) { return name.ends_with(".gz") || name.ends_with(".GZ"); }

void require_gzip(std::string_view bytes) {
  if (bytes.empty()) throw Error(ErrorKind::bad_input, "", "byte 0", "the file is empty");
  if (is_gzip(bytes)) return;
  throw Error(ErrorKind::bad_input, "", "byte 0", "no gzip data, though the name ends in .gz");
}

PolygonMesh read_polygons(FileFormat format, std::string_view bytes, const ReadOptions& options) {
  Cursor cursor(bytes);
  if (format == FileFormat::stl_binary) return detail::read_stl_binary(cursor, options.soup);
  cursor.take(bytes.size() - detail::without_mark(bytes).size());
  switch (format) {
    case FileFormat::off:
      return detail::read_off(cursor);
    case FileFormat::obj:
      return detail::read_obj(cursor);
    case FileFormat::ply:
      return detail::read_ply(cursor);
    case FileFormat::vtk:
      return detail::read_vtk(cursor);
    case FileFormat::glb:
      return detail::read_glb(cursor);
    case FileFormat::freesurfer_text:
      return detail::read_freesurfer_text(cursor);
    case FileFormat::freesurfer_binary:
      return detail::read_freesurfer_binary(cursor);
    default:
      return detail::read_stl_text(cursor, options.soup);
  }
}

const char* name_of(FileFormat format) {
  switch (format) {
    case FileFormat::off:
      return "off";
    case FileFormat::obj:
      return "obj";
    case FileFormat::ply:
      return "ply";
    case FileFormat::vtk:
      return "vtk";
    case FileFormat::glb:
      return "glb";
    case FileFormat::freesurfer_text:
    case FileFormat::freesurfer_binary:
      return "freesurfer";
    default:
      return "stl";
  }
}

MeshFile read_plain(std::string_view bytes, std::string_view name, const ReadOptions& options) {
  const FileFormat format = detail::detect_format(bytes, bytes.size(), name).value();
  MeshFile file = detail::assemble(read_polygons(format, bytes, options));
  file.format = name_of(format);
  return file;
}

}  // namespace

MeshFile read_mesh_bytes(std::string_view bytes, const std::string& name,
                         const ReadOptions& options) {
  try {
    const bool named_gz = ends_with_gz(name);
    if (named_gz) require_gzip(bytes);
    if (!named_gz && !(name == "-" && is_gzip(bytes))) return read_plain(bytes, name, options);
    const std::string content = unpack_gzip(bytes, options.size_limit);
    return read_plain(content, name.substr(0, name.size() - (named_gz ? 3 : 0)), options);
  } catch (const Error& error) {
    throw error.in_file(name);
  }
}

MeshFile read_mesh(const std::string& path, const ReadOptions& options) {
  const auto inspect = [&](std::string_view head, std::uint64_t size) {
    try {
      if (ends_with_gz(path)) {
        require_gzip(head);
      } else {
        (void)detail::detect_format(head, size, path);
      }
    } catch (const Error& error) {
      throw error.in_file(path);
    }
  };
  const std::string bytes =
      read_bytes(path, {.size_limit = options.size_limit, .inspect = inspect});
  return read_mesh_bytes(bytes, path, options);
}

}  // namespace timbre

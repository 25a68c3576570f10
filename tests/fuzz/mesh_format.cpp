// One mesh format: any bytes become a sound mesh, which survives writing and reading, or one line.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "timbre/analysis/mesh/detail/formats.h"
#include "timbre/analysis/mesh/diagnosis.h"
#include "timbre/analysis/mesh/read_mesh.h"
#include "timbre/analysis/mesh/write_mesh.h"
#include "timbre/tests/fuzz/memory_watch.h"
#include "timbre/tests/fuzz/target.h"
#include "timbre/tests/fuzz/tested_format.h"

namespace timbre::fuzz {
namespace {

using detail::FileFormat;

FileFormat format_under_test() {
  constexpr std::array<std::pair<std::string_view, FileFormat>, 9> kFormats = {
      {{"off", FileFormat::off},
       {"obj", FileFormat::obj},
       {"ply", FileFormat::ply},
       {"stl_text", FileFormat::stl_text},
       {"stl_binary", FileFormat::stl_binary},
       {"freesurfer_text", FileFormat::freesurfer_text},
       {"freesurfer_binary", FileFormat::freesurfer_binary},
       {"vtk", FileFormat::vtk},
       {"glb", FileFormat::glb}}};
  for (const auto& [word, format] : kFormats) {
    if (word == tested_format) return format;
  }
  require(false, "the format under test is known");
  return {};
}
const FileFormat kFormat = format_under_test();

// Of `stl_text` the ending is `stl`.
std::string input_name() {
  const std::string word = tested_format;
  return "input." + word.substr(0, word.find('_'));
}

// Others have targets of their own.
bool is_of_this_format(std::string_view input) {
  try {
    return detail::detect_format(input, input.size(), input_name()) == kFormat;
  } catch (const Error& error) {
    require_plain(error, ErrorKind::bad_input);
    return false;
  }
}

// Elements of a mesh for each byte of a GLB, whose scene may place a mesh again and again.
constexpr std::size_t kMostElements = 16;

// Enough for what the tables of a mesh take beside the text that they come from.
std::size_t most_memory(std::string_view input, const MeshFile& file) {
  std::size_t what_is_there = input.size();
  if (kFormat == FileFormat::glb) {
    const auto elements =
        static_cast<std::size_t>(file.mesh.vertices.rows() + file.mesh.faces.size());
    require(elements <= kMostElements * input.size(), "few bytes do not make a large mesh");
    what_is_there += elements;
  }
  return 200 * what_is_there + (std::size_t{1} << 16);
}

std::optional<MeshFile> read(std::string_view input, const ReadOptions& options = {}) {
  try {
    const MemoryWatch watch;
    MeshFile file = read_mesh_bytes(input, input_name(), options);
    require(watch.peak() <= most_memory(input, file), "a reader takes memory for what is there");
    return file;
  } catch (const Error& error) {
    require_plain(error, ErrorKind::bad_input);
    require(error.file() == input_name(), "an error names the file");
    require(!error.place().empty(), "an error names the place");
    return std::nullopt;
  }
}

std::int64_t count_of(const MeshFile& file, std::string_view code) {
  for (const ReadWarning& warning : file.warnings) {
    if (warning.code == code) return warning.count;
  }
  return 0;
}

std::int64_t count_unused(const TriangleMesh& mesh) {
  if (mesh.faces.rows() == 0) return 0;
  std::vector<bool> used(static_cast<std::size_t>(mesh.vertices.rows()), false);
  for (const std::int32_t corner : mesh.faces.reshaped()) {
    used[static_cast<std::size_t>(corner)] = true;
  }
  return std::count(used.begin(), used.end(), false);
}

std::int64_t count_coincident(const Points& points) {
  std::vector<std::array<double, 3>> sorted;
  for (const auto& row : points.rowwise()) sorted.push_back({row[0], row[1], row[2]});
  std::sort(sorted.begin(), sorted.end());
  return std::distance(std::unique(sorted.begin(), sorted.end()), sorted.end());
}

void require_sound(const MeshFile& file) {
  const auto& [vertices, faces] = file.mesh;
  require(vertices.allFinite(), "coordinates are finite");
  require(faces.size() == 0 || faces.minCoeff() >= 0, "indices are not negative");
  require(faces.size() == 0 || faces.maxCoeff() < vertices.rows(), "indices are in range");
  const bool by_code =
      std::is_sorted(file.warnings.begin(), file.warnings.end(),
                     [](const ReadWarning& a, const ReadWarning& b) { return a.code < b.code; });
  require(by_code, "warnings are sorted");
  for (const ReadWarning& warning : file.warnings) {
    require(warning.count > 0, "warnings count something");
  }
  require(count_of(file, "no-faces") == (faces.rows() == 0 ? 1 : 0), "no-faces is right");
  require(count_of(file, "unused-vertex") == count_unused(file.mesh), "unused-vertex is right");
  require(count_of(file, "coincident-vertex") == count_coincident(vertices),
          "coincident-vertex is right");
}

bool same(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices.rows() == b.vertices.rows() && a.faces.rows() == b.faces.rows() &&
         std::equal(a.vertices.data(), a.vertices.data() + a.vertices.size(), b.vertices.data(),
                    [](double x, double y) {
                      return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
                    }) &&
         a.faces == b.faces;
}

void require_round_trip(const TriangleMesh& mesh) {
  for (const MeshFormat format : {MeshFormat::off, MeshFormat::obj, MeshFormat::ply,
                                  MeshFormat::freesurfer_text, MeshFormat::vtk}) {
    if (mesh.vertices.rows() == 0 && format == MeshFormat::obj) continue;  // cannot say so
    const std::string bytes = to_mesh_bytes(mesh, format);
    require(same(read_mesh_bytes(bytes, "written").mesh, mesh), "what is written is read back");
  }
}

// Formats with float coordinates keep no more than these.
void require_round_trip_of_floats(TriangleMesh mesh) {
  if (mesh.faces.rows() == 0) return;  // cannot say so
  for (double& c : mesh.vertices.reshaped()) {
    if (std::abs(c) > std::numeric_limits<float>::max()) return;
    c = static_cast<float>(c);
  }
  require(same(read_mesh_bytes(to_mesh_bytes(mesh, MeshFormat::glb), "written").mesh, mesh),
          "a written GLB is read back");
  const TriangleMesh facets =
      read_mesh_bytes(to_mesh_bytes(mesh, MeshFormat::stl), "written", {.soup = true}).mesh;
  require(facets.vertices == mesh.vertices(mesh.faces.reshaped<Eigen::RowMajor>(), Eigen::all),
          "a written STL has the same facets");
}

// A file's last line may lack its end, and may be followed by empty ones.
void require_indifference_to_space_at_the_end(std::string_view input, const MeshFile& file) {
  if (kFormat == FileFormat::stl_binary) return;
  const std::string longer = std::string(input) + "\n \n";
  try {
    if (detail::detect_format(longer, longer.size(), input_name()) != kFormat) return;
    require(same(read_mesh_bytes(longer, input_name()).mesh, file.mesh),
            "white space at the end changes nothing");
  } catch (const Error&) {
    require(false, "white space at the end does no harm");
  }
}

void require_plain_diagnosis(const MeshFile& file) {
  const Diagnosis found = diagnose(file.mesh);
  require(found.vertices == file.mesh.vertices.rows(), "the diagnosis counts vertices");
  require(found.faces == file.mesh.faces.rows(), "the diagnosis counts faces");
  require(!std::isnan(found.area) && found.area >= 0.0, "an area is 0 or more");
}

void require_soup_of_the_same_facets(std::string_view input, const MeshFile& file) {
  const std::optional<MeshFile> soup = read(input, {.soup = true});
  require(soup.has_value(), "a soup is read where a surface is");
  require(soup->mesh.faces.rows() == file.mesh.faces.rows(), "a soup has the same facets");
  require(soup->mesh.vertices.rows() == 3 * soup->mesh.faces.rows(), "a soup has 3 m vertices");
  require(soup->mesh.vertices.rows() - file.mesh.vertices.rows() == count_of(file, "welded"),
          "welded is right");
}

}  // namespace

void examine(std::string_view input) {
  if (!is_of_this_format(input)) return;
  const std::optional<MeshFile> file = read(input);
  if (!file) return;
  require_sound(*file);
  require_plain_diagnosis(*file);
  // Larger only where a scene places a mesh again and again, and then slow to write so often.
  if (std::cmp_greater(file->mesh.faces.rows(), input.size())) return;
  require_round_trip(file->mesh);
  require_round_trip_of_floats(file->mesh);
  require_indifference_to_space_at_the_end(input, *file);
  if (file->format == "stl") require_soup_of_the_same_facets(input, *file);
}

}  // namespace timbre::fuzz

#include "timbre/datasets/detail/vert_tri.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <system_error>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/datasets/detail/word_lines.h"

namespace timbre::detail {
namespace {

namespace fs = std::filesystem;

double number_in(const WordLines& line, std::size_t column) {
  const std::optional<double> value = parse_double(line.words()[column]);
  if (!value) line.refuse("'" + line.word(column) + "' is not a number");
  return *value;
}

// A line of three, or an end.
bool next_triple(WordLines& line) {
  if (!line.next()) return false;
  if (line.words().size() != 3) line.refuse("three numbers are wanted");
  return true;
}

Points read_points(const std::string& file) {
  std::vector<double> values;
  for (WordLines line(file); next_triple(line);) {
    for (std::size_t c = 0; c < 3; ++c) values.push_back(number_in(line, c));
  }
  if (values.empty()) throw Error(ErrorKind::bad_input, file, "", "holds no point");
  return Eigen::Map<const Points>(values.data(), std::ssize(values) / 3, 3);
}

Faces read_triangles(const std::string& file, std::int64_t vertices) {
  std::vector<std::int32_t> corners;
  for (WordLines line(file); next_triple(line);) {
    for (std::size_t c = 0; c < 3; ++c) {
      // Some copies write 1.0.
      const double v = number_in(line, c);
      if (!(v >= 1.0 && v <= static_cast<double>(vertices)) || v != std::floor(v)) {
        line.refuse("'" + line.word(c) + "' is no vertex; they count from 1 to " +
                    std::to_string(vertices));
      }
      corners.push_back(static_cast<std::int32_t>(v) - 1);
    }
  }
  return Eigen::Map<const Faces>(corners.data(), std::ssize(corners) / 3, 3);
}

}  // namespace

MeshFile read_vert_tri(const std::string& file, const ReadOptions& options) {
  const std::string triangles = fs::path(file).replace_extension(".tri").string();
  for (const std::string& part : {file, triangles}) {
    std::error_code failure;
    if (fs::file_size(part, failure) > options.size_limit && !failure) {
      throw Error(ErrorKind::bad_input, part, "size",
                  "larger than the limit of " + std::to_string(options.size_limit) + " bytes");
    }
  }
  MeshFile result;
  result.format = "vert";
  result.mesh.vertices = read_points(file);
  if (result.mesh.vertices.rows() > std::numeric_limits<std::int32_t>::max()) {
    throw Error(ErrorKind::bad_input, file, "", "holds more points than can be numbered");
  }
  result.mesh.faces = read_triangles(triangles, result.mesh.vertices.rows());
  return result;
}

}  // namespace timbre::detail

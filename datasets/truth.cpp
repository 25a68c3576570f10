#include "timbre/datasets/truth.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/datasets/detail/word_lines.h"
#include "timbre/datasets/random.h"

namespace timbre {
namespace {

namespace fs = std::filesystem;

std::string beside(const ShapeSet& set, const SetShape& shape, const char* ending) {
  return (fs::path(set.truth_folder) / (shape_stem(shape.name) + ending)).string();
}

bool exists(const std::string& path) {
  std::error_code failure;
  return fs::exists(path, failure);
}

std::int32_t vertex_from(const detail::WordLines& line, std::size_t column, std::int32_t first,
                         std::int64_t vertices) {
  const std::optional<std::int64_t> number = parse_integer(line.words()[column]);
  if (!number) line.refuse("'" + line.word(column) + "' is no integer");
  if (*number >= vertices + first) {
    line.refuse(line.word(column) + " is no vertex; there are " + std::to_string(vertices) +
                (first == 0 ? ", from 0" : ", from 1"));
  }
  return static_cast<std::int32_t>(std::max<std::int64_t>(*number, first - 1) - first);
}

void add_known_rows(Truth& truth, const std::vector<std::int32_t>& source,
                    const std::vector<std::int32_t>& target) {
  for (std::size_t i = 0; i < source.size(); ++i) {
    if (source[i] < 0 || target[i] < 0) continue;
    truth.source.push_back(source[i]);
    truth.target.push_back(target[i]);
  }
}

void require_rows(const Truth& truth, const std::string& path) {
  if (!truth.source.empty()) return;
  throw Error(ErrorKind::bad_input, path, "", "tells nothing: no row is known on both sides");
}

// Of symmetry.txt; beyond the last where there is none for the shape.
std::size_t column_of(const std::vector<std::string>& names, const SetShape& shape) {
  if (names.size() == 1 && names[0] == "all") return 0;
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), shape.label) -
                                  names.begin());
}

// The column of symmetry.txt for a shape: for each point of the template its image, -1 none.
std::vector<std::int32_t> template_symmetry(const std::string& path, const SetShape& shape,
                                            std::size_t points) {
  detail::WordLines line(path);
  if (!line.next()) throw Error(ErrorKind::bad_input, path, "", "is empty");
  const std::vector<std::string> names(line.words().begin(), line.words().end());
  const std::size_t column = column_of(names, shape);
  if (column == names.size()) {
    line.refuse("has no column '" + shape.label + "' for " + shape.name);
  }
  std::vector<std::int32_t> image;
  while (image.size() < points && line.next()) {
    if (line.words().size() != names.size()) {
      line.refuse("has " + std::to_string(line.words().size()) + " columns, not " +
                  std::to_string(names.size()));
    }
    image.push_back(vertex_from(line, column, 1, static_cast<std::int64_t>(points)));
  }
  if (image.size() < points) {
    throw Error(ErrorKind::bad_input, path, "",
                "has " + std::to_string(image.size()) + " rows; the template of " + shape.name +
                    " has " + std::to_string(points) + " points");
  }
  return image;
}

}  // namespace

std::vector<std::int32_t> read_vertex_list(const std::string& path, std::int32_t first,
                                           std::int64_t vertices) {
  std::vector<std::int32_t> list;
  for (detail::WordLines line(path); line.next();) {
    if (line.words().size() != 1) line.refuse("one vertex is wanted");
    list.push_back(vertex_from(line, 0, first, vertices));
  }
  return list;
}

Truth map_truth(const ShapeSet& set, const SetShape& source, std::int64_t sources,
                const SetShape& target, std::int64_t targets) {
  const std::string from = beside(set, source, ".vts");
  const std::string to = beside(set, target, ".vts");
  const std::string part = beside(set, source, ".map");
  Truth truth;
  truth.partial = exists(part);
  if (exists(from) && exists(to)) {
    const std::vector<std::int32_t> p = read_vertex_list(from, 1, sources);
    const std::vector<std::int32_t> q = read_vertex_list(to, 1, targets);
    if (p.size() != q.size()) {
      throw Error(ErrorKind::bad_input, to, "",
                  "has " + std::to_string(q.size()) + " points and " + from + " has " +
                      std::to_string(p.size()) + ": not of one template");
    }
    add_known_rows(truth, p, q);
    require_rows(truth, from);
    return truth;
  }
  if (!truth.partial && exists(from) != exists(to)) {
    throw Error(ErrorKind::bad_input, exists(from) ? to : from, "",
                "is missing; the other shape of the pair has its own");
  }
  if (!truth.partial && sources != targets) {
    throw Error(ErrorKind::bad_input, source.file, "",
                "nothing tells where its vertices belong on " + target.name +
                    ": no .vts of both, no .map, and the numbers of vertices differ");
  }
  std::vector<std::int32_t> numbers(static_cast<std::size_t>(sources));
  for (std::size_t v = 0; v < numbers.size(); ++v) numbers[v] = static_cast<std::int32_t>(v);
  if (!truth.partial) return {numbers, numbers, false};
  const std::vector<std::int32_t> image = read_vertex_list(part, 0, targets);
  if (image.size() != numbers.size()) {
    throw Error(ErrorKind::bad_input, part, "",
                "has " + std::to_string(image.size()) + " lines; " + source.name + " has " +
                    std::to_string(sources) + " vertices");
  }
  add_known_rows(truth, numbers, image);
  require_rows(truth, part);
  return truth;
}

Truth symmetry_truth(const ShapeSet& set, const SetShape& shape, std::int64_t vertices) {
  const std::string own = beside(set, shape, ".vts");
  const std::string direct = beside(set, shape, ".sym.vts");
  if (!exists(own) || (!exists(direct) && set.symmetry_columns.empty())) {
    throw Error(ErrorKind::bad_input, shape.file, "",
                "no symmetry is known: neither .vts with .sym.vts nor .vts with symmetry.txt");
  }
  const std::vector<std::int32_t> vertex = read_vertex_list(own, 1, vertices);
  std::vector<std::int32_t> image;
  if (exists(direct)) {
    image = read_vertex_list(direct, 1, vertices);
    if (image.size() != vertex.size()) {
      throw Error(ErrorKind::bad_input, direct, "",
                  "has " + std::to_string(image.size()) + " lines and " + own + " has " +
                      std::to_string(vertex.size()));
    }
  } else {
    const std::string table = (fs::path(set.folder) / "symmetry.txt").string();
    for (const std::int32_t t : template_symmetry(table, shape, vertex.size())) {
      image.push_back(t < 0 ? -1 : vertex[static_cast<std::size_t>(t)]);
    }
  }
  Truth truth;
  add_known_rows(truth, vertex, image);
  require_rows(truth, own);
  return truth;
}

Truth mirrored(const Truth& truth, const Truth& symmetry, std::int64_t vertices) {
  std::vector<std::int32_t> image(static_cast<std::size_t>(vertices), -1);
  for (std::size_t i = 0; i < symmetry.source.size(); ++i) {
    image[static_cast<std::size_t>(symmetry.source[i])] = symmetry.target[i];
  }
  std::vector<std::int32_t> target;
  target.reserve(truth.target.size());
  for (const std::int32_t v : truth.target) target.push_back(image[static_cast<std::size_t>(v)]);
  Truth result;
  result.partial = truth.partial;
  add_known_rows(result, truth.source, target);
  return result;
}

Truth sampled(const Truth& truth, std::size_t count) {
  if (truth.source.size() <= count) return truth;
  Random random("truth", {1});
  std::vector<std::int32_t> rows =
      random.permutation(static_cast<std::int32_t>(truth.source.size()));
  rows.resize(count);
  std::sort(rows.begin(), rows.end());
  Truth result;
  result.partial = truth.partial;
  for (const std::int32_t row : rows) {
    result.source.push_back(truth.source[static_cast<std::size_t>(row)]);
    result.target.push_back(truth.target[static_cast<std::size_t>(row)]);
  }
  return result;
}

const char* truth_form(const ShapeSet& set, const SetShape& shape) {
  if (exists(beside(set, shape, ".vts"))) return "vts";
  return exists(beside(set, shape, ".map")) ? "map" : "numbers";
}

bool has_symmetry_truth(const ShapeSet& set, const SetShape& shape) {
  return exists(beside(set, shape, ".vts")) &&
         (exists(beside(set, shape, ".sym.vts")) ||
          column_of(set.symmetry_columns, shape) < set.symmetry_columns.size());
}

}  // namespace timbre

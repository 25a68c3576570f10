#include "timbre/datasets/shape_set.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <map>
#include <optional>
#include <system_error>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/datasets/detail/word_lines.h"
#include "timbre/datasets/random.h"

namespace timbre {
namespace {

namespace fs = std::filesystem;

constexpr std::array kMeshFolders = {"",       "off",           "shapes",
                                     "meshes", "registrations", "training/registrations"};
constexpr std::array kMeshEndings = {".off", ".obj", ".ply", ".stl", ".vert"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_mesh_name(const std::string& name) {
  const std::string plain = name.ends_with(".gz") ? name.substr(0, name.size() - 3) : name;
  return std::any_of(kMeshEndings.begin(), kMeshEndings.end(),
                     [&](const char* ending) { return plain.ends_with(ending); });
}

std::string stem_of(const std::string& name) { return name.substr(0, name.find('.')); }

// cat2 before cat10.
bool comes_before(const std::string& a, const std::string& b) {
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size(); ++i, ++j) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const auto run = [](const std::string& text, std::size_t& at) {
        const std::size_t first = std::min(text.find_first_not_of('0', at), text.size());
        at = first;
        while (at < text.size() && is_digit(text[at])) ++at;
        return text.substr(first, at - first);
      };
      const std::string left = run(a, i);
      const std::string right = run(b, j);
      if (left.size() != right.size()) return left.size() < right.size();
      if (left != right) return left < right;
      --i;
      --j;
    } else if (a[i] != b[j]) {
      return a[i] < b[j];
    }
  }
  return a.size() != b.size() ? a.size() < b.size() : a < b;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code failure;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    names.push_back(entry->path().filename().string());
  }
  if (failure) throw Error(ErrorKind::io, folder.string(), "", failure.message());
  std::sort(names.begin(), names.end(), comes_before);
  return names;
}

void find_meshes(ShapeSet& set) {
  for (const char* inner : kMeshFolders) {
    const fs::path folder = *inner == '\0' ? fs::path(set.folder) : fs::path(set.folder) / inner;
    std::error_code failure;
    if (*inner != '\0' && !fs::is_directory(folder, failure)) continue;
    for (const std::string& name : names_in(folder)) {
      if (is_mesh_name(name)) set.shapes.push_back({(folder / name).string(), name, ""});
    }
    if (set.shapes.empty()) continue;
    const fs::path apart = fs::path(set.folder) / "corres";
    set.truth_folder = fs::is_directory(apart, failure) ? apart.string() : folder.string();
    return;
  }
  throw Error(ErrorKind::bad_input, set.folder, "",
              "holds no mesh (.off, .obj, .ply, .stl, .vert with .tri), nor do its folders off, "
              "shapes, meshes, registrations");
}

bool is_number(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
}

// The number that follows `prefix` and is all that follows.
std::optional<std::string> number_after(const std::string& stem, const std::string& prefix) {
  if (!stem.starts_with(prefix) || !is_number(stem.substr(prefix.size()))) return std::nullopt;
  return stem.substr(prefix.size());
}

// What `layout` reads from a name; nothing if the name does not fit.
std::optional<std::string> label_by_name(SetLayout layout, const std::string& stem) {
  if (layout == SetLayout::faust) {
    const std::optional<std::string> number = number_after(stem, "tr_reg_");
    if (!number || number->size() != 3) return std::nullopt;
    return std::to_string(*parse_integer(*number) / 10);
  }
  if (layout == SetLayout::scape) {
    if (!number_after(stem, "mesh")) return std::nullopt;
    return "scape";
  }
  if (layout == SetLayout::shrec) {
    const std::optional<std::int64_t> number =
        is_number(stem) ? parse_integer(stem) : std::optional<std::int64_t>();
    if (!number || *number < 1 || *number > 400) return std::nullopt;
    return std::to_string((*number + 19) / 20);
  }
  const std::size_t digits = stem.find_last_not_of("0123456789") + 1;
  std::string word = stem.substr(0, digits);
  while (!word.empty() && (word.back() == '_' || word.back() == '-')) word.pop_back();
  if (digits == stem.size() || word.empty()) return std::nullopt;
  return word;
}

bool label_by_names(ShapeSet& set, SetLayout layout) {
  std::vector<std::string> labels;
  for (const SetShape& shape : set.shapes) {
    const std::optional<std::string> label = label_by_name(layout, stem_of(shape.name));
    if (!label) return false;
    labels.push_back(*label);
  }
  for (std::size_t i = 0; i < labels.size(); ++i) set.shapes[i].label = labels[i];
  set.layout = layout;
  return true;
}

// FILE LABEL ...; `?` is no label.
void label_by_list(ShapeSet& set, const std::string& list) {
  for (const detail::WordLine& line : detail::read_word_lines(list)) {
    const std::string place = "line " + std::to_string(line.number);
    const auto shape = std::find_if(set.shapes.begin(), set.shapes.end(), [&](const SetShape& one) {
      return one.name == line.words[0] || stem_of(one.name) == line.words[0];
    });
    if (shape == set.shapes.end()) {
      throw Error(ErrorKind::bad_input, list, place, line.words[0] + " is not in the folder");
    }
    if (line.words.size() < 2) {
      throw Error(ErrorKind::bad_input, list, place, "has no label after the file");
    }
    shape->label = line.words[1] == "?" ? "" : line.words[1];
  }
  set.layout = SetLayout::listed;
}

// PSB 1 / classes models / then of each class: name parent count, and the numbers of its models.
void label_by_cla(ShapeSet& set, const std::string& list) {
  const std::vector<detail::WordLine> lines = detail::read_word_lines(list);
  std::map<std::string, std::string> label_of;
  std::string label;
  std::int64_t left = 0;
  for (std::size_t i = 2; i < lines.size(); ++i) {
    const std::vector<std::string>& words = lines[i].words;
    const std::string place = "line " + std::to_string(lines[i].number);
    if (left > 0) {
      if (words.size() != 1 || !is_number(words[0])) {
        throw Error(ErrorKind::bad_input, list, place, "the number of a model is wanted");
      }
      label_of[words[0]] = label;
      --left;
      continue;
    }
    const std::optional<std::int64_t> count =
        words.size() == 3 ? parse_integer(words[2]) : std::optional<std::int64_t>();
    if (!count || *count < 0) {
      throw Error(ErrorKind::bad_input, list, place, "a class (name parent count) is wanted");
    }
    label = words[0];
    left = *count;
  }
  if (lines.size() < 2 || lines[0].words[0] != "PSB" || left > 0) {
    throw Error(ErrorKind::bad_input, list, "", "is no whole PSB class file");
  }
  for (SetShape& shape : set.shapes) {
    const std::string stem = stem_of(shape.name);
    const auto known = label_of.find(stem.substr(stem.find_first_of("0123456789")));
    if (known != label_of.end()) shape.label = known->second;
  }
  set.layout = SetLayout::cla;
}

void label_shapes(ShapeSet& set) {
  for (const char* name : {"labels.txt", "classes.txt"}) {
    const fs::path list = fs::path(set.folder) / name;
    std::error_code failure;
    if (fs::exists(list, failure)) return label_by_list(set, list.string());
  }
  const bool numbered = std::all_of(set.shapes.begin(), set.shapes.end(), [](const SetShape& one) {
    return number_after(stem_of(one.name), "T").has_value();
  });
  for (const std::string& name : names_in(set.folder)) {
    if (numbered && name.ends_with(".cla")) {
      return label_by_cla(set, (fs::path(set.folder) / name).string());
    }
  }
  for (const SetLayout layout :
       {SetLayout::faust, SetLayout::scape, SetLayout::shrec, SetLayout::words}) {
    if (label_by_names(set, layout)) return;
  }
}

void read_pairs(ShapeSet& set, const std::string& list) {
  set.pairs_listed = true;
  for (const detail::WordLine& line : detail::read_word_lines(list)) {
    const std::string place = "line " + std::to_string(line.number);
    if (line.words.size() != 2) {
      throw Error(ErrorKind::bad_input, list, place, "two files are wanted");
    }
    for (const std::string& word : line.words) {
      const bool known = std::any_of(set.shapes.begin(), set.shapes.end(),
                                     [&](const SetShape& shape) { return shape.name == word; });
      if (!known) throw Error(ErrorKind::bad_input, list, place, word + " is not in the folder");
    }
    set.pairs.emplace_back(line.words[0], line.words[1]);
  }
}

// All registrations of FAUST correspond, whoever the subject is.
void make_pairs(ShapeSet& set) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (std::size_t a = 0; a < set.shapes.size(); ++a) {
    for (std::size_t b = a + 1; b < set.shapes.size(); ++b) {
      if (set.shapes[a].label != set.shapes[b].label && set.layout != SetLayout::faust) continue;
      pairs.emplace_back(set.shapes[a].name, set.shapes[b].name);
    }
  }
  Random random("pairs", {1});
  for (const std::int32_t i : random.permutation(static_cast<std::int32_t>(pairs.size()))) {
    set.pairs.push_back(pairs[static_cast<std::size_t>(i)]);
  }
}

double number_in(const detail::WordLine& line, std::size_t column, const std::string& file) {
  const std::optional<double> value = parse_double(line.words[column]);
  if (value) return *value;
  throw Error(ErrorKind::bad_input, file, "line " + std::to_string(line.number),
              "'" + line.words[column] + "' is not a number");
}

// Three numbers a line.
Points read_triples(const std::string& file) {
  const std::vector<detail::WordLine> lines = detail::read_word_lines(file);
  Points rows(static_cast<Eigen::Index>(lines.size()), 3);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].words.size() != 3) {
      throw Error(ErrorKind::bad_input, file, "line " + std::to_string(lines[i].number),
                  "three numbers are wanted");
    }
    for (std::size_t c = 0; c < 3; ++c) {
      rows(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) =
          number_in(lines[i], c, file);
    }
  }
  return rows;
}

MeshFile read_vert_tri(const std::string& file) {
  const std::string triangles = fs::path(file).replace_extension(".tri").string();
  MeshFile result;
  result.format = "vert";
  result.mesh.vertices = read_triples(file);
  const Points corners = read_triples(triangles);
  const auto n = static_cast<double>(result.mesh.vertices.rows());
  result.mesh.faces.resize(corners.rows(), 3);
  for (Eigen::Index f = 0; f < corners.rows(); ++f) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      const double v = corners(f, c);
      if (!(v >= 1.0 && v <= n) || v != static_cast<double>(static_cast<std::int32_t>(v))) {
        throw Error(ErrorKind::bad_input, triangles, "triangle " + std::to_string(f),
                    to_text(v) + " is no vertex; they count from 1 to " + to_text(n));
      }
      result.mesh.faces(f, c) = static_cast<std::int32_t>(v) - 1;
    }
  }
  return result;
}

}  // namespace

const char* to_word(SetLayout layout) {
  switch (layout) {
    case SetLayout::listed:
      return "listed";
    case SetLayout::cla:
      return "cla";
    case SetLayout::faust:
      return "faust";
    case SetLayout::scape:
      return "scape";
    case SetLayout::shrec:
      return "shrec";
    case SetLayout::words:
      return "words";
    default:
      return "plain";
  }
}

ShapeSet read_shape_set(const std::string& folder) {
  ShapeSet set;
  set.folder = folder;
  find_meshes(set);
  label_shapes(set);
  const fs::path list = fs::path(folder) / "pairs.txt";
  std::error_code failure;
  if (fs::exists(list, failure)) {
    read_pairs(set, list.string());
  } else {
    make_pairs(set);
  }
  return set;
}

const SetShape& find_shape(const ShapeSet& set, const std::string& name) {
  for (const SetShape& shape : set.shapes) {
    if (shape.name == name) return shape;
  }
  throw Error(ErrorKind::bad_request, set.folder, "", "has no shape " + name);
}

MeshFile read_set_mesh(const std::string& file, const ReadOptions& options) {
  return file.ends_with(".vert") ? read_vert_tri(file) : read_mesh(file, options);
}

}  // namespace timbre

#include "timbre/datasets/shape_set.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <unordered_map>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/datasets/detail/vert_tri.h"
#include "timbre/datasets/detail/word_lines.h"
#include "timbre/datasets/random.h"

namespace timbre {
namespace {

namespace fs = std::filesystem;

constexpr std::array kMeshFolders = {"",       "off",           "shapes",
                                     "meshes", "registrations", "training/registrations"};
constexpr std::array kMeshEndings = {".off", ".obj", ".ply", ".stl", ".vtk", ".glb", ".vert"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string without_gz(const std::string& name) {
  return name.ends_with(".gz") ? name.substr(0, name.size() - 3) : name;
}

bool is_mesh_name(const std::string& name) {
  if (name.starts_with('.') || name.ends_with(".vert.gz")) return false;
  std::string plain = without_gz(name);
  std::transform(plain.begin(), plain.end(), plain.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return std::any_of(kMeshEndings.begin(), kMeshEndings.end(),
                     [&](const char* ending) { return plain.ends_with(ending); });
}

// The digits from `at` on, without leading zeros; `at` moves behind them.
std::string_view take_number(std::string_view text, std::size_t& at) {
  const std::size_t first = std::min(text.find_first_not_of('0', at), text.size());
  at = first;
  while (at < text.size() && is_digit(text[at])) ++at;
  return text.substr(first, at - first);
}

// cat2 before cat10.
bool comes_before(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view left = take_number(a, i);
      const std::string_view right = take_number(b, j);
      if (left.size() != right.size()) return left.size() < right.size();
      if (left != right) return left < right;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  const bool a_ends = i == a.size();
  const bool b_ends = j == b.size();
  if (a_ends != b_ends) return a_ends;
  return a < b;  // alike but for leading zeros
}

// Of files; what is a folder or a device is no mesh, whatever its name.
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code failure;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    std::error_code ignored;
    if (!entry->is_regular_file(ignored)) continue;
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
  throw Error(
      ErrorKind::bad_input, set.folder, "",
      "holds no mesh (.off, .obj, .ply, .stl, .vtk, .glb, .vert with .tri), nor do its folders "
      "off, shapes, meshes, registrations");
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
    const std::optional<std::string> label = label_by_name(layout, shape_stem(shape.name));
    if (!label) return false;
    labels.push_back(*label);
  }
  for (std::size_t i = 0; i < labels.size(); ++i) set.shapes[i].label = labels[i];
  set.layout = layout;
  return true;
}

// Shapes by the names that lists have for them.
class Names {
 public:
  explicit Names(const ShapeSet& set) : set_(set) {
    for (std::size_t i = 0; i < set.shapes.size(); ++i) {
      by_stem_.try_emplace(shape_stem(set.shapes[i].name), i);
      by_name_.emplace(set.shapes[i].name, i);
    }
  }

  [[nodiscard]] std::size_t find(const detail::WordLines& line, std::size_t column) const {
    const std::string word = line.word(column);
    for (const auto* names : {&by_name_, &by_stem_}) {
      const auto shape = names->find(word);
      if (shape != names->end()) return shape->second;
    }
    const bool is_part =
        std::any_of(set_.shapes.begin(), set_.shapes.end(), [&](const SetShape& shape) {
          return shape.name.starts_with(word) && shape.name.find_first_of(" \t,") == word.size();
        });
    line.refuse(
        "'" + word + "' is not in the folder" +
        (is_part ? "; lists cannot hold names with blanks or commas: rename the file" : ""));
  }

 private:
  const ShapeSet& set_;
  std::unordered_map<std::string, std::size_t> by_name_, by_stem_;
};

// FILE LABEL ...; `?` is no label.
void label_by_list(ShapeSet& set, const std::string& list) {
  const Names names(set);
  std::vector<bool> is_labelled(set.shapes.size(), false);
  for (detail::WordLines line(list); line.next();) {
    const std::size_t i = names.find(line, 0);
    if (line.words().size() < 2) line.refuse("has no label after the file");
    const std::string label = line.words()[1] == "?" ? "" : line.word(1);
    if (is_labelled[i] && set.shapes[i].label != label) {
      line.refuse("labels " + set.shapes[i].name + " a second time");
    }
    set.shapes[i].label = label;
    is_labelled[i] = true;
  }
  set.layout = SetLayout::listed;
}

// PSB 1 / classes models / then of each class: name parent count, and the numbers of its models.
void label_by_cla(ShapeSet& set, const std::string& list) {
  std::map<std::string, std::string> label_of;
  std::string label;
  std::int64_t left = 0;
  detail::WordLines line(list);
  const bool is_begun = line.next() && line.words()[0] == "PSB" && line.next();
  while (is_begun && line.next()) {
    if (left > 0) {
      if (line.words().size() != 1 || !is_number(line.word(0))) {
        line.refuse("the number of a model is wanted");
      }
      label_of[line.word(0)] = label;
      --left;
      continue;
    }
    const std::optional<std::int64_t> count =
        line.words().size() == 3 ? parse_integer(line.words()[2]) : std::optional<std::int64_t>();
    if (!count || *count < 0) line.refuse("a class (name parent count) is wanted");
    label = line.word(0);
    left = *count;
  }
  if (!is_begun || left > 0) {
    throw Error(ErrorKind::bad_input, list, "", "is no whole PSB class file");
  }
  for (SetShape& shape : set.shapes) {
    const auto known = label_of.find(shape_stem(shape.name).substr(1));  // T0
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
    return number_after(shape_stem(one.name), "T").has_value();
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
  const Names names(set);
  std::set<std::pair<std::size_t, std::size_t>> seen;
  set.pairs_listed = true;
  for (detail::WordLines line(list); line.next();) {
    if (line.words().size() != 2) line.refuse("two files are wanted");
    const std::size_t a = names.find(line, 0);
    const std::size_t b = names.find(line, 1);
    if (!seen.emplace(a, b).second) line.refuse("names this pair a second time");
    set.pairs.emplace_back(set.shapes[a].name, set.shapes[b].name);
  }
}

// All registrations of FAUST correspond, whoever the subject is; where no name tells a label,
// all may. Else a shape without label belongs to none.
std::vector<std::vector<std::size_t>> groups_of(const ShapeSet& set) {
  const bool is_one = set.layout == SetLayout::faust || set.layout == SetLayout::plain;
  std::map<std::string, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < set.shapes.size(); ++i) {
    if (is_one || !set.shapes[i].label.empty()) {
      groups[is_one ? "" : set.shapes[i].label].push_back(i);
    }
  }
  std::vector<std::vector<std::size_t>> result;
  result.reserve(groups.size());
  for (const auto& [label, group] : groups) result.push_back(group);
  return result;
}

// `wanted` of the numbers below `total`, in random order.
std::vector<std::int64_t> draw(std::int64_t total, std::int64_t wanted) {
  Random random("pairs", {1});
  std::vector<std::int64_t> drawn;
  if (total <= wanted) {
    for (const std::int32_t i : random.permutation(static_cast<std::int32_t>(total))) {
      drawn.push_back(i);
    }
    return drawn;
  }
  std::set<std::int64_t> seen;
  while (std::ssize(drawn) < wanted) {
    const auto number = static_cast<std::int64_t>(random.uniform(0.0, static_cast<double>(total)));
    if (seen.insert(number).second) drawn.push_back(number);
  }
  return drawn;
}

// Numbers the pairs without making them: a large folder has more than memory holds.
void make_pairs(ShapeSet& set) {
  struct First {
    std::int64_t start;  // pairs before those that begin with this shape
    const std::vector<std::size_t>* group;
    std::size_t at;
  };
  const std::vector<std::vector<std::size_t>> groups = groups_of(set);
  std::vector<First> firsts;
  std::int64_t total = 0;
  for (const std::vector<std::size_t>& group : groups) {
    for (std::size_t at = 0; at < group.size(); ++at) {
      firsts.push_back({total, &group, at});
      total += std::ssize(group) - 1 - static_cast<std::int64_t>(at);
    }
  }
  for (const std::int64_t number : draw(total, kMostPairs)) {
    const auto after = std::upper_bound(
        firsts.begin(), firsts.end(), number,
        [](std::int64_t wanted, const First& first) { return wanted < first.start; });
    const First& first = *std::prev(after);
    const std::size_t other = first.at + 1 + static_cast<std::size_t>(number - first.start);
    set.pairs.emplace_back(set.shapes[(*first.group)[first.at]].name,
                           set.shapes[(*first.group)[other]].name);
  }
}

// The names in the first line of symmetry.txt.
void read_symmetry_columns(ShapeSet& set) {
  const std::string table = (fs::path(set.folder) / "symmetry.txt").string();
  std::error_code failure;
  if (!fs::exists(table, failure)) return;
  detail::WordLines line(table);
  if (!line.next()) throw Error(ErrorKind::bad_input, table, "", "is empty");
  set.symmetry_columns.assign(line.words().begin(), line.words().end());
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

std::string shape_stem(const std::string& name) {
  const std::string plain = without_gz(name);
  const std::size_t dot = plain.find_last_of('.');
  return dot == 0 ? plain : plain.substr(0, dot);
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
  read_symmetry_columns(set);
  return set;
}

const SetShape& find_shape(const ShapeSet& set, const std::string& name) {
  for (const SetShape& shape : set.shapes) {
    if (shape.name == name) return shape;
  }
  throw Error(ErrorKind::bad_request, set.folder, "", "has no shape " + name);
}

MeshFile read_set_mesh(const std::string& file, const ReadOptions& options) {
  return file.ends_with(".vert") ? detail::read_vert_tri(file, options) : read_mesh(file, options);
}

}  // namespace timbre

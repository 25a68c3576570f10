#include "timbre/index/labels.h"

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>
#include <vector>

#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

// No label can be this: they hold no control characters.
constexpr char kDisagree[] = "\n";

std::string base_name(std::string_view path) {
  const std::size_t slash = path.find_last_of('/');
  return std::string(slash == std::string_view::npos ? path : path.substr(slash + 1));
}

void strip_ending(std::string& name) {
  const std::size_t dot = name.find_last_of('.');
  if (dot != std::string::npos && dot > 0) name.resize(dot);
}

}  // namespace

std::string shape_name_of(std::string_view path) {
  std::string name = base_name(path);
  if (name.size() > 3 && name.ends_with(".gz")) name.resize(name.size() - 3);
  strip_ending(name);
  return name;
}

Labels::Labels(const std::string& path, int column) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(ErrorKind::io, path, "", std::generic_category().message(errno));
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line);
    std::vector<std::string> columns;
    for (std::string word; words >> word;) columns.push_back(word);
    if (columns.empty()) continue;
    const std::string place = "line " + std::to_string(number);
    if (columns.size() < static_cast<std::size_t>(column)) {
      throw Error(ErrorKind::bad_input, path, place,
                  "has " + std::to_string(columns.size()) + " columns; the label is wanted in " +
                      std::to_string(column));
    }
    std::string label = columns[static_cast<std::size_t>(column - 1)];
    if (label == "?") label.clear();
    const auto known = by_file_.find(base_name(columns[0]));
    if (known != by_file_.end() && known->second != label) {
      throw Error(ErrorKind::bad_input, path, place, "labels " + columns[0] + " a second time");
    }
    add(base_name(columns[0]), label);
  }
  if (in.bad()) throw Error(ErrorKind::io, path, "read", "failed");
}

void Labels::add(const std::string& file, const std::string& label) {
  by_file_[file] = label;
  const auto [entry, is_new] = by_stem_.emplace(shape_name_of(file), label);
  if (!is_new && entry->second != label) entry->second = kDisagree;
}

std::string Labels::of(const std::string& file_or_name) const {
  const std::string base = base_name(file_or_name);
  if (const auto exact = by_file_.find(base); exact != by_file_.end()) return exact->second;
  // A stored name has lost its ending already, and may hold dots of its own.
  for (const std::string& stem : {base, shape_name_of(base)}) {
    const auto entry = by_stem_.find(stem);
    if (entry != by_stem_.end() && entry->second != kDisagree) return entry->second;
  }
  return {};
}

}  // namespace timbre

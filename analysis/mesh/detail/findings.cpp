#include "timbre/analysis/mesh/detail/findings.h"

namespace timbre::detail {
namespace {

constexpr std::size_t kPlaces = 5;

struct Words {
  const char* code;
  const char* phrase;  // for a person; the count follows
  const char* place;   // what the places are
};

constexpr std::array<Words, kFindings> kWords = {{
    {"coincident-vertex", "vertices at the position of an earlier one", "vertex"},
    {"crude-split", "polygons too large to be split well", "face"},
    {"degenerate-face", "faces without area", "face"},
    {"dropped-element", "points and lines left out", "face"},
    {"duplicate-face", "faces with the corners of an earlier one", "face"},
    {"extra-values", "vertices with values after x y z, not read", "vertex"},
    {"glued-header", "header and first count not separated", ""},
    {"ignored-data", "kinds of data not read", ""},
    {"no-faces", "a mesh without faces", ""},
    {"trailing-data", "more data than the header declares, not read", ""},
    {"triangulated", "polygons split into triangles", "face"},
    {"unused-vertex", "vertices in no face", "vertex"},
    {"welded", "STL corners joined with an earlier one at the same position", ""},
}};

}  // namespace

void Findings::add(Finding what, std::int64_t element) {
  Entry& to = entry(what);
  ++to.count;
  if (to.places.size() < kPlaces) to.places.push_back(std::to_string(element));
}

void Findings::add(Finding what, std::string_view word) {
  Entry& to = entry(what);
  ++to.count;
  if (to.places.size() < kPlaces) to.places.emplace_back(word.substr(0, 40));
}

std::vector<ReadWarning> Findings::warnings() const {
  std::vector<ReadWarning> all;
  for (std::size_t i = 0; i < kFindings; ++i) {
    const Entry& from = entries_[i];
    if (from.count == 0) continue;
    const Words& words = kWords[i];
    std::string message = words.phrase + (": " + std::to_string(from.count));
    for (std::size_t p = 0; p < from.places.size(); ++p) {
      message += p > 0 ? ", " : *words.place != '\0' ? std::string(" (") + words.place + " " : " (";
      message += from.places[p];
    }
    if (from.places.size() < static_cast<std::size_t>(from.count) && !from.places.empty()) {
      message += ", ...";
    }
    if (!from.places.empty()) message += ")";
    all.push_back({words.code, from.count, message});
  }
  return all;
}

}  // namespace timbre::detail

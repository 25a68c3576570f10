#include "timbre/cli/commands/map_judge.h"

#include <algorithm>
#include <filesystem>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/stopwatch.h"
#include "timbre/cli/commands/map_output.h"
#include "timbre/matching/classic/functional_map.h"
#include "timbre/matching/match.h"
#include "timbre/matching/symmetry.h"

namespace timbre::cli {
namespace {

namespace fs = std::filesystem;

std::string base_name(const std::string& file) { return fs::path(file).filename().string(); }

// A set as a folder of one pair: what lies beside the two files.
ShapeSet set_beside(const std::string& source, const std::string& target) {
  ShapeSet set;
  const fs::path folder = fs::path(source).parent_path();
  set.folder = set.truth_folder = folder.empty() ? "." : folder.string();
  try {
    set = read_shape_set(set.folder);
  } catch (const Error&) {
    // A folder that is no set still holds these two, and what lies beside them.
  }
  const auto add = [&](const std::string& file) {
    const std::string name = fs::path(file).filename().string();
    const bool known = std::any_of(set.shapes.begin(), set.shapes.end(),
                                   [&](const SetShape& one) { return one.name == name; });
    if (!known) set.shapes.push_back({file, name, ""});
  };
  add(source);
  add(target);
  return set;
}

std::vector<std::int32_t> listed_map(const std::string& file, const TriangleMesh& A,
                                     const TriangleMesh& B) {
  std::vector<std::int32_t> map = read_vertex_list(file, 0, B.vertices.rows());
  if (static_cast<Eigen::Index>(map.size()) == A.vertices.rows()) return map;
  throw Error(ErrorKind::bad_input, file, "",
              "has " + std::to_string(map.size()) + " lines; the source has " +
                  std::to_string(A.vertices.rows()) + " vertices");
}

// A vertex of the target for each of the source.
Truth listed_truth(const std::string& file, const TriangleMesh& A, const TriangleMesh& B) {
  const std::vector<std::int32_t> image = listed_map(file, A, B);
  Truth truth;
  for (std::size_t v = 0; v < image.size(); ++v) {
    if (image[v] < 0) continue;
    truth.source.push_back(static_cast<std::int32_t>(v));
    truth.target.push_back(image[v]);
  }
  return truth;
}

}  // namespace

Judged MapJudge::judge_file(const std::string& source, const std::string& target,
                            const std::string& map) const {
  const ShapeSet set = set_beside(source, target);
  const SetShape& a = find_shape(set, base_name(source));
  const SetShape& b = find_shape(set, base_name(target));
  const TriangleMesh A = load(source);
  const TriangleMesh B = load(target);
  const Truth truth =
      options_.truth.empty() ? truth_of(set, a, A, b, B) : listed_truth(options_.truth, A, B);
  Judged judged{a.name, b.name, {}, {}, nlohmann::json::object()};
  compare(listed_map(map, A, B), truth, set, b, B, judged);
  return judged;
}

Judged MapJudge::judge_pair(const ShapeSet& set, const std::string& source,
                            const std::string& target) {
  const SetShape& a = find_shape(set, source);
  const SetShape& b = find_shape(set, target);
  const TriangleMesh A = load(a.file);
  const TriangleMesh B = load(b.file);
  const Truth truth = truth_of(set, a, A, b, B);
  Judged judged{source, target, {}, {}, nlohmann::json::object()};
  Stopwatch watch;
  const bool is_given = !options_.maps.empty();
  const std::vector<std::int32_t> map =
      is_given ? listed_map(map_file(options_.maps, source, target), A, B)
               : compute(a, A, b, B, judged.made);
  if (!is_given) judged.made["seconds"] = watch.lap();
  if (!options_.save.empty()) {
    context_.write_result(map_file(options_.save, source, target), to_lines(map));
  }
  for_file(b.file, [&] { compare(map, truth, set, b, B, judged); });
  return judged;
}

TriangleMesh MapJudge::load(const std::string& file) const {
  return read_set_mesh(file, context_.read).mesh;
}

Truth MapJudge::truth_of(const ShapeSet& set, const SetShape& a, const TriangleMesh& A,
                         const SetShape& b, const TriangleMesh& B) const {
  if (options_.kind == TruthKind::symmetry) return symmetry_truth(set, a, A.vertices.rows());
  return map_truth(set, a, A.vertices.rows(), b, B.vertices.rows());
}

void MapJudge::compare(const std::vector<std::int32_t>& map, const Truth& known,
                       const ShapeSet& set, const SetShape& target, const TriangleMesh& B,
                       Judged& judged) const {
  const ErrorScale scale(B, options_.geodesic);
  const Truth truth =
      options_.samples == 0 ? known : sampled(known, static_cast<std::size_t>(options_.samples));
  judged.score = score_map(map, truth, scale, context_.threads);
  if (options_.kind != TruthKind::map || !has_symmetry_truth(set, target)) return;
  const Truth opposite =
      mirrored(truth, symmetry_truth(set, target, B.vertices.rows()), B.vertices.rows());
  if (opposite.source.empty()) return;
  judged.mirrored_error = score_map(map, opposite, scale, context_.threads).mean_error;
}

std::string MapJudge::map_file(const std::string& folder, const std::string& source,
                               const std::string& target) const {
  const auto stem = [](const std::string& name) { return name.substr(0, name.find_last_of('.')); };
  const std::string name =
      options_.kind == TruthKind::symmetry ? stem(source) : stem(source) + "_" + stem(target);
  return (fs::path(folder) / (name + ".txt")).string();
}

// Spectra are the costly part of a pair; those of the last few shapes are kept, the latest
// last, so that both of a pair stay.
const MatchSurface& MapJudge::surface(const SetShape& shape, const TriangleMesh& mesh) {
  constexpr std::size_t kKept = 16;
  for (auto entry = surfaces_.begin(); entry != surfaces_.end(); ++entry) {
    if (entry->first != shape.name) continue;
    surfaces_.splice(surfaces_.end(), surfaces_, entry);
    return surfaces_.back().second;
  }
  if (surfaces_.size() == kKept) surfaces_.pop_front();
  MatchSurface made = for_file(shape.file, [&] {
    return prepare_surface(mesh, {.eigenpairs = options_.count,
                                  .threads = context_.threads,
                                  .progress = context_.progress()});
  });
  surfaces_.emplace_back(shape.name, std::move(made));
  return surfaces_.back().second;
}

std::vector<std::int32_t> MapJudge::compute(const SetShape& a, const TriangleMesh& A,
                                            const SetShape& b, const TriangleMesh& B,
                                            nlohmann::json& made) {
  const MatchSurface& from = surface(a, A);
  if (options_.kind == TruthKind::symmetry) {
    const std::vector<Reflection> found =
        find_reflections(from, {.threads = context_.threads, .progress = context_.progress()});
    if (!found.empty()) return found[0].map;
    return std::vector<std::int32_t>(static_cast<std::size_t>(A.vertices.rows()), -1);
  }
  const MatchSurface& to = surface(b, B);
  if (options_.method == MatchMethod::functional) {
    return match_by_descriptors(from, to, {.threads = context_.threads});
  }
  MatchResult result =
      match(from, to, {.threads = context_.threads, .progress = context_.progress()});
  made["verdict"] = to_word(result.verdict);
  return std::move(result.ab);
}

}  // namespace timbre::cli

#include "timbre/cli/commands/map_judge.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/output_file.h"
#include "timbre/analysis/core/stopwatch.h"
#include "timbre/cli/array_input.h"
#include "timbre/cli/commands/map_output.h"
#include "timbre/matching/classic/functional_map.h"
#include "timbre/matching/match.h"
#include "timbre/matching/symmetry.h"

namespace timbre::cli {
namespace {

namespace fs = std::filesystem;

std::string base_name(const std::string& file) { return fs::path(file).filename().string(); }

fs::path folder_of(const std::string& file) {
  const fs::path folder = fs::path(file).parent_path();
  return folder.empty() ? "." : folder;
}

bool lie_together(const std::string& a, const std::string& b) {
  std::error_code failure;
  return fs::equivalent(folder_of(a), folder_of(b), failure) && !failure;
}

// The set in whose folder a mesh lies, with this mesh.
ShapeSet set_beside(const std::string& mesh) {
  ShapeSet set;
  set.folder = set.truth_folder = folder_of(mesh).string();
  const std::string folder = set.folder;
  try {
    set = read_shape_set(folder);
  } catch (const Error& error) {
    // A folder that is no set still has what lies beside the mesh. A broken list is told.
    if (error.file() != folder) throw;
  }
  return set;
}

// Files need not look like meshes of a set.
const SetShape& shape_of(ShapeSet& set, const std::string& file) {
  const std::string name = base_name(file);
  const auto known = std::find_if(set.shapes.begin(), set.shapes.end(),
                                  [&](const SetShape& one) { return one.name == name; });
  if (known != set.shapes.end()) return *known;
  return set.shapes.emplace_back(SetShape{file, name, ""});
}

std::vector<std::int32_t> listed_map(const Context& context, const std::string& file,
                                     const TriangleMesh& A, const TriangleMesh& B) {
  std::vector<std::int32_t> map = file.ends_with(".npy")
                                      ? read_point_map(context, file)
                                      : read_vertex_list(file, 0, B.vertices.rows());
  if (static_cast<Eigen::Index>(map.size()) != A.vertices.rows()) {
    throw Error(ErrorKind::bad_input, file, "",
                "has " + std::to_string(map.size()) + " lines; the source has " +
                    std::to_string(A.vertices.rows()) + " vertices");
  }
  const auto most = map.empty() ? map.end() : std::max_element(map.begin(), map.end());
  if (most != map.end() && *most >= B.vertices.rows()) {
    throw Error(ErrorKind::bad_input, file, "row " + std::to_string(most - map.begin()),
                std::to_string(*most) + " is no vertex; there are " +
                    std::to_string(B.vertices.rows()) + ", from 0");
  }
  return map;
}

// A vertex of the target for each of the source.
Truth listed_truth(const Context& context, const std::string& file, const TriangleMesh& A,
                   const TriangleMesh& B) {
  const std::vector<std::int32_t> image = listed_map(context, file, A, B);
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
  if (options_.truth.empty() && !lie_together(source, target)) {
    throw Error(ErrorKind::bad_request, "", "inputs",
                "SOURCE and TARGET lie in different folders; --truth FILE has to tell the truth");
  }
  ShapeSet set = set_beside(target);
  const SetShape a = lie_together(source, target) ? shape_of(set, source)
                                                  : SetShape{source, base_name(source), ""};
  const SetShape b = shape_of(set, target);
  const TriangleMesh A = load(source);
  const TriangleMesh B = load(target);
  const Truth truth = options_.truth.empty() ? truth_of(set, a, A, b, B)
                                             : listed_truth(context_, options_.truth, A, B);
  Judged judged{a.name, b.name, {}, {}, nlohmann::json::object()};
  const std::vector<std::int32_t> listed = listed_map(context_, map, A, B);
  for_file(b.file, [&] { compare(listed, truth, set, b, B, judged); });
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
  if (!options_.save.empty()) {
    require_writable(map_file(options_.save, source, target), replaces_maps());
  }
  Stopwatch watch;
  const bool is_given = !options_.maps.empty();
  const std::vector<std::int32_t> map =
      is_given ? listed_map(context_, map_file(options_.maps, source, target), A, B)
               : compute(a, A, b, B, judged.made);
  if (!is_given) judged.made["seconds"] = watch.lap();
  for_file(b.file, [&] { compare(map, truth, set, b, B, judged); });
  if (!options_.save.empty()) {
    write_file(map_file(options_.save, source, target), to_lines(map), replaces_maps());
  }
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
  judged.score = score_map(map, truth, scale, context_.threads, context_.progress());
  if (options_.kind != TruthKind::map || !has_symmetry_truth(set, target)) return;
  const Truth opposite =
      mirrored(truth, symmetry_truth(set, target, B.vertices.rows()), B.vertices.rows());
  if (opposite.source.empty()) return;
  judged.mirrored_error =
      score_map(map, opposite, scale, context_.threads, context_.progress()).mean_error;
}

std::string MapJudge::map_file(const std::string& folder, const std::string& source,
                               const std::string& target) const {
  const std::string name = options_.kind == TruthKind::symmetry
                               ? shape_stem(source)
                               : shape_stem(source) + "_" + shape_stem(target);
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
    return match_by_descriptors(from, to,
                                {.threads = context_.threads, .progress = context_.progress()});
  }
  MatchResult result =
      match(from, to, {.threads = context_.threads, .progress = context_.progress()});
  made["verdict"] = to_word(result.verdict);
  return std::move(result.ab);
}

}  // namespace timbre::cli

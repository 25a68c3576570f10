#pragma once

#include <cstdint>
#include <list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "timbre/cli/command.h"
#include "timbre/datasets/map_scores.h"
#include "timbre/datasets/shape_set.h"
#include "timbre/matching/surface.h"

namespace timbre::cli {

enum class TruthKind : std::uint8_t { map, symmetry };
enum class MatchMethod : std::uint8_t { tensor, functional };

struct JudgeOptions {
  TruthKind kind = TruthKind::map;
  MatchMethod method = MatchMethod::tensor;
  GeodesicKind geodesic = GeodesicKind::exact;
  int count = 200;       ///< eigenfunctions
  int samples = 0;       ///< rows of the truth that are judged; 0: all
  std::string maps;      ///< folder of maps to judge; empty: compute them
  std::string truth;     ///< of one map; empty: what lies beside the meshes
  std::string save;      ///< folder for the maps that are computed; empty: they are not kept
  bool goes_on = false;  ///< a run that was interrupted may have left maps there
};

/// A map, compared with the truth.
struct Judged {
  std::string source, target;
  MapScore score;
  /// The mean error of the same map against the mirror image of the truth, where the left-right
  /// symmetry of the target is known.
  std::optional<double> mirrored_error;
  nlohmann::json made = nlohmann::json::object();  ///< how the map came to be: verdict, seconds
};

/// Makes or reads maps and compares them with the truth.
class MapJudge {
 public:
  MapJudge(const JudgeOptions& options, const Context& context)
      : options_(options), context_(context) {}

  /// A map in a file between two meshes (of a symmetry: the same one twice).
  [[nodiscard]] Judged judge_file(const std::string& source, const std::string& target,
                                  const std::string& map) const;

  /// A pair of a set.
  [[nodiscard]] Judged judge_pair(const ShapeSet& set, const std::string& source,
                                  const std::string& target);

 private:
  [[nodiscard]] bool replaces_maps() const { return context_.force || options_.goes_on; }
  [[nodiscard]] TriangleMesh load(const std::string& file) const;
  [[nodiscard]] Truth truth_of(const ShapeSet& set, const SetShape& a, const TriangleMesh& A,
                               const SetShape& b, const TriangleMesh& B) const;
  void compare(const std::vector<std::int32_t>& map, const Truth& known, const ShapeSet& set,
               const SetShape& target, const TriangleMesh& B, Judged& judged) const;
  [[nodiscard]] std::string map_file(const std::string& folder, const std::string& source,
                                     const std::string& target) const;
  [[nodiscard]] const MatchSurface& surface(const SetShape& shape, const TriangleMesh& mesh);
  [[nodiscard]] std::vector<std::int32_t> compute(const SetShape& a, const TriangleMesh& A,
                                                  const SetShape& b, const TriangleMesh& B,
                                                  nlohmann::json& made);

  const JudgeOptions& options_;
  const Context& context_;
  std::list<std::pair<std::string, MatchSurface>> surfaces_;
};

}  // namespace timbre::cli

#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace timbre::detail {

using Placement = Eigen::AffineCompact3d;

/// A node of the scene. Its children and its mesh are numbers as the file counts them.
struct GlbNode {
  std::vector<std::int64_t> children;
  std::int64_t mesh = -1;  ///< -1: none
  Placement placement = Placement::Identity();
  bool has_skin = false;       ///< then the node's place means nothing
  bool has_instances = false;  ///< EXT_mesh_gpu_instancing
};

enum class GlbMode : std::uint8_t { points, lines, line_loop, line_strip, triangles, strip, fan };

struct GlbPrimitive {
  GlbMode mode = GlbMode::triangles;
  std::int64_t positions = -1;  ///< accessor
  std::int64_t indices = -1;    ///< accessor; -1: the positions one after the other
  bool has_targets = false;     ///< morph targets
};

/// Where the elements of an accessor lie in the BIN chunk; all do.
struct GlbElements {
  std::size_t begin = 0;   ///< byte of the first
  std::size_t stride = 0;  ///< bytes from one to the next, at least `size`
  std::size_t size = 0;    ///< bytes of one
  std::int64_t count = 0;
};

/// What the JSON chunk says, looked up and checked when it is asked for.
class GlbDocument {
 public:
  /// @param json_begin  where `json` begins in the file, for errors
  /// @param bin_size    bytes of the BIN chunk
  /// @throws Error  bad_input if this is no JSON, or if the geometry needs an extension
  GlbDocument(std::string_view json, std::size_t json_begin, std::size_t bin_size);
  GlbDocument(const GlbDocument&) = delete;
  GlbDocument& operator=(const GlbDocument&) = delete;
  ~GlbDocument();

  // All of these throw Error, bad_input, with the element and the cause.

  [[nodiscard]] std::int64_t node_count() const;
  [[nodiscard]] std::int64_t mesh_count() const;
  [[nodiscard]] bool has_scenes() const;
  /// The nodes of the default scene or of the first; without scenes, those in no other node.
  [[nodiscard]] std::vector<std::int64_t> roots() const;
  [[nodiscard]] GlbNode node(std::int64_t number) const;
  [[nodiscard]] std::vector<GlbPrimitive> primitives(std::int64_t mesh) const;
  /// Elements of three 32-bit floats.
  [[nodiscard]] GlbElements positions(std::int64_t accessor) const;
  /// Unsigned integers of 1, 2 or 4 bytes.
  [[nodiscard]] GlbElements indices(std::int64_t accessor) const;

 private:
  struct Content;
  std::unique_ptr<const Content> content_;
};

}  // namespace timbre::detail

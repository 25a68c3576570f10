#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "timbre/analysis/mesh/detail/formats.h"
#include "timbre/analysis/mesh/detail/glb_document.h"

namespace timbre::detail {
namespace {

constexpr std::endian kOrder = std::endian::little;

// The parts of a file. Views into it; chunks of other kinds are passed over.
struct Chunks {
  std::string_view json;
  std::size_t json_begin = 0;
  Cursor bin{std::string_view()};  // at the beginning of the BIN chunk, which may have no bytes
  std::size_t bin_size = 0;
  bool has_trailing_data = false;
};

Chunks read_chunks(Cursor cursor) {
  constexpr std::uint32_t kVersion = 2;
  constexpr std::uint32_t kJson = 0x4e4f534a;
  constexpr std::uint32_t kBin = 0x004e4942;
  const std::string_view file = cursor.rest();
  Chunks chunks;
  cursor.take(4);
  if (const auto version = cursor.value<std::uint32_t>(kOrder); version != kVersion) {
    throw cursor.error("glTF version " + std::to_string(version) + "; version 2 is read");
  }
  const auto length = cursor.value<std::uint32_t>(kOrder);
  if (length < 20)
    throw cursor.error("a length of " + std::to_string(length) + " bytes; 20 is the least");
  if (length > file.size()) {
    throw cursor.error("truncated: " + std::to_string(length) +
                       " bytes are declared, the file has " + std::to_string(file.size()));
  }
  chunks.has_trailing_data =
      file.substr(length).find_first_not_of(" \t\r\n\v\f") != std::string_view::npos;

  Cursor body(file.substr(0, length));
  body.take(12);
  for (std::size_t number = 0; number == 0 || body.left() > 0; ++number) {
    const auto size = body.value<std::uint32_t>(kOrder);
    const auto kind = body.value<std::uint32_t>(kOrder);
    if (number == 0 && kind != kJson) throw body.error("the first chunk must be 'JSON'");
    const Cursor begin = body;
    const std::string_view bytes = body.take(size);
    if (number == 0) {
      chunks.json = bytes;
      chunks.json_begin = body.last_offset();
    } else if (number == 1 && kind == kBin) {
      chunks.bin = begin;
      chunks.bin_size = size;
    }
  }
  return chunks;
}

// Mirrors, which turn triangles round. Each row is brought to unit size, for the product of
// three small numbers may be 0.
bool is_mirror(const Placement& placement) {
  Eigen::Matrix3d rows = placement.linear();
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (const double largest = rows.row(i).cwiseAbs().maxCoeff(); largest > 0.0) {
      rows.row(i) /= largest;
    }
  }
  return rows.determinant() < 0.0;
}

class GlbReader {
 public:
  GlbReader(const Chunks& chunks, std::size_t file_size)
      : document_(chunks.json, chunks.json_begin, chunks.bin_size),
        bin_(chunks.bin),
        most_elements_(kMostElements * file_size) {
    if (chunks.has_trailing_data) mesh_.findings.add_count(Finding::trailing_data);
  }

  PolygonMesh read() {
    if (document_.node_count() > 0 || document_.has_scenes()) {
      walk();
    } else {
      for (std::int64_t m = 0; m < document_.mesh_count(); ++m) add_mesh(m, Placement::Identity());
    }
    if (has_skin_) mesh_.findings.add(Finding::ignored_data, "skin");
    if (has_targets_) mesh_.findings.add(Finding::ignored_data, "morph targets");
    if (has_instances_) mesh_.findings.add(Finding::ignored_data, "EXT_mesh_gpu_instancing");
    return std::move(mesh_);
  }

 private:
  // Of the mesh, for each byte of the file: a few bytes may place a large mesh again and again.
  static constexpr std::uint64_t kMostElements = 16;
  static constexpr std::int64_t kVisit = 8;  // as many elements as a look at a primitive takes time

  struct Visit {
    std::int64_t node = 0;
    Placement parent;
  };

  // Nodes before their children, children in order.
  void walk() {
    seen_.assign(static_cast<std::size_t>(document_.node_count()), false);
    push(document_.roots(), Placement::Identity());
    while (!open_.empty()) {
      const Visit visit = std::move(open_.back());
      open_.pop_back();
      const GlbNode node = document_.node(visit.node);
      const Placement placement = visit.parent * node.placement;
      if (node.mesh >= 0) add_mesh(node.mesh, node.has_skin ? Placement::Identity() : placement);
      has_skin_ |= node.has_skin;
      has_instances_ |= node.has_instances;
      push(node.children, placement);
    }
    if (document_.has_scenes()) return;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      if (!seen_[i]) throw no_tree(static_cast<std::int64_t>(i));
    }
  }

  void push(const std::vector<std::int64_t>& nodes, const Placement& parent) {
    const auto before = static_cast<std::ptrdiff_t>(open_.size());
    for (const std::int64_t node : nodes) {
      if (std::cmp_less(node, seen_.size())) {
        auto seen = seen_[static_cast<std::size_t>(node)];
        if (seen) throw no_tree(node);
        seen = true;
      }
      open_.push_back({node, parent});
    }
    std::reverse(open_.begin() + before, open_.end());
  }

  void add_mesh(std::int64_t number, const Placement& placement) {
    std::map<std::int64_t, std::int32_t> first_of;  // vertex of an accessor's first position
    const std::string place = "mesh " + std::to_string(number);
    std::size_t index = 0;
    for (const GlbPrimitive& primitive : document_.primitives(number)) {
      const std::string here = place + ", primitive " + std::to_string(index++);
      charge(kVisit, here);
      if (primitive.mode < GlbMode::triangles) {
        mesh_.findings.add_count(Finding::dropped_element);
        continue;
      }
      const GlbElements positions = document_.positions(primitive.positions);
      const auto [vertices, is_new] = first_of.try_emplace(
          primitive.positions, static_cast<std::int32_t>(mesh_.vertex_count()));
      if (is_new) {
        charge(positions.count, here);
        add_vertices(positions, placement);
      }
      has_targets_ |= primitive.has_targets;
      add_faces(primitive, vertices->second, positions.count, is_mirror(placement), here);
    }
  }

  void add_vertices(const GlbElements& positions, const Placement& placement) {
    constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
    if (positions.count > kMost - mesh_.vertex_count()) {
      throw Error(ErrorKind::bad_input, "", "size", "more than 2147483647 vertices");
    }
    const bool stays = placement.matrix() == Placement::Identity().matrix();
    Cursor cursor = at(positions);
    for (std::int64_t i = 0; i < positions.count; ++i) {
      cursor.enter("vertex", mesh_.vertex_count());
      if (i > 0) cursor.take(positions.stride - positions.size);
      Eigen::Vector3d position;
      for (double& c : position) {
        c = cursor.value<float>(kOrder);
        if (!std::isfinite(c)) throw cursor.error("coordinate is not finite");
      }
      if (!stays) position = placement * position;
      if (!position.allFinite()) {
        throw cursor.error("its node moves it beyond the range of a double");
      }
      mesh_.add_vertex(position.x(), position.y(), position.z());
    }
  }

  void add_faces(const GlbPrimitive& primitive, std::int32_t first, std::int64_t vertices,
                 bool mirrored, const std::string& place) {
    const bool listed = primitive.indices >= 0;
    const GlbElements indices =
        listed ? document_.indices(primitive.indices) : GlbElements{.count = vertices};
    charge(indices.count, place);
    require_corners(primitive.mode, indices.count, place);
    Cursor cursor = at(indices);
    std::array<std::int32_t, 3> last{};  // this corner, the one before, and the one before that
    std::int32_t hub = 0;
    for (std::int64_t i = 0; i < indices.count; ++i) {
      cursor.enter("face", static_cast<std::int64_t>(mesh_.polygon_count()));
      if (listed && i > 0) cursor.take(indices.stride - indices.size);
      const std::int32_t corner =
          first + (listed ? index(cursor, indices.size, vertices) : static_cast<std::int32_t>(i));
      last = {corner, last[0], last[1]};
      if (i == 0) hub = corner;
      if (primitive.mode == GlbMode::triangles ? i % 3 < 2 : i < 2) continue;
      if (primitive.mode == GlbMode::fan) {
        add_face(last[1], last[0], hub, mirrored);
      } else if (primitive.mode == GlbMode::strip && i % 2 == 1) {  // every other runs back
        add_face(last[2], last[0], last[1], mirrored);
      } else {
        add_face(last[2], last[1], last[0], mirrored);
      }
    }
  }

  void require_corners(GlbMode mode, std::int64_t count, const std::string& place) {
    if (mode == GlbMode::triangles && count % 3 != 0) {
      throw Error(ErrorKind::bad_input, "", place,
                  std::to_string(count) + " corners; triangles have three each");
    }
    if (count < 3) mesh_.findings.add_count(Finding::dropped_element);
  }

  void add_face(std::int32_t a, std::int32_t b, std::int32_t c, bool mirrored) {
    mesh_.corners.push_back(a);
    mesh_.corners.push_back(mirrored ? c : b);
    mesh_.corners.push_back(mirrored ? b : c);
    mesh_.end_polygon();
  }

  static std::int32_t index(Cursor& cursor, std::size_t size, std::int64_t vertices) {
    const std::int64_t value = size == 1   ? cursor.value<std::uint8_t>(kOrder)
                               : size == 2 ? cursor.value<std::uint16_t>(kOrder)
                                           : std::int64_t{cursor.value<std::uint32_t>(kOrder)};
    if (value < vertices) return static_cast<std::int32_t>(value);
    throw cursor.error("index " + std::to_string(value) + " is out of range; the primitive has " +
                       std::to_string(vertices) + " vertices");
  }

  [[nodiscard]] Cursor at(const GlbElements& elements) const {
    Cursor cursor = bin_;
    cursor.take(elements.begin);
    return cursor;
  }

  // Counts vertices and corners before they are made.
  void charge(std::int64_t elements, const std::string& place) {
    elements_ += static_cast<std::uint64_t>(elements);
    if (elements_ <= most_elements_) return;
    throw Error(ErrorKind::bad_input, "", place,
                "placed so often that the mesh has more than " + std::to_string(kMostElements) +
                    " vertices and corners for each byte of the file");
  }

  static Error no_tree(std::int64_t node) {
    return {ErrorKind::bad_input, "", "node " + std::to_string(node),
            "lies in two nodes, or in itself; nodes must form a tree"};
  }

  GlbDocument document_;
  Cursor bin_;
  std::uint64_t most_elements_;
  std::uint64_t elements_ = 0;
  PolygonMesh mesh_;
  std::vector<bool> seen_;
  std::vector<Visit> open_;
  bool has_skin_ = false;
  bool has_targets_ = false;
  bool has_instances_ = false;
};

}  // namespace

PolygonMesh read_glb(Cursor cursor) {
  const std::size_t size = cursor.left();
  return GlbReader(read_chunks(cursor), size).read();
}

}  // namespace timbre::detail

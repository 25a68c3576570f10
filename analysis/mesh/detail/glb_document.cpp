#include "timbre/analysis/mesh/detail/glb_document.h"

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/detail/cursor.h"

namespace timbre::detail {
namespace {

using nlohmann::json;

Error refusal(const std::string& place, const std::string& cause) {
  return {ErrorKind::bad_input, "", place, cause};
}

// An object of the document, with what errors call it. Members that a reader does not need
// are never looked at.
class Part {
 public:
  Part(const json& value, std::string name) : value_(&value), name_(std::move(name)) {
    if (!value.is_object()) throw error("a JSON object is needed");
  }

  [[nodiscard]] Error error(const std::string& cause) const { return refusal(name_, cause); }
  [[nodiscard]] const std::string& name() const { return name_; }

  [[nodiscard]] const json* find(const char* key) const {
    const auto found = value_->find(key);
    return found == value_->end() ? nullptr : &*found;
  }
  [[nodiscard]] bool has(const char* key) const { return find(key) != nullptr; }

  [[nodiscard]] std::int64_t integer(const char* key, std::int64_t otherwise) const {
    const json* const value = find(key);
    return value == nullptr ? otherwise : checked(*value, key);
  }
  [[nodiscard]] std::int64_t integer(const char* key) const {
    if (!has(key)) throw missing(key);
    return integer(key, 0);
  }
  [[nodiscard]] std::vector<std::int64_t> integers(const char* key) const {
    std::vector<std::int64_t> all;
    const json* const list = array(key);
    if (list == nullptr) return all;
    all.reserve(list->size());
    for (const json& value : *list) all.push_back(checked(value, key));
    return all;
  }
  // Empty if there are none.
  [[nodiscard]] std::vector<double> numbers(const char* key, std::size_t count) const {
    std::vector<double> all;
    const json* const list = array(key);
    if (list == nullptr) return all;
    const bool fits =
        list->size() == count && std::all_of(list->begin(), list->end(),
                                             [](const json& value) { return value.is_number(); });
    if (!fits) throw error(in_quotes(key) + " needs " + std::to_string(count) + " numbers");
    for (const json& value : *list) all.push_back(value.get<double>());
    return all;
  }
  [[nodiscard]] std::string text(const char* key) const {
    const json* const value = find(key);
    if (value == nullptr || !value->is_string()) throw missing(key);
    return value->get<std::string>();
  }
  [[nodiscard]] const json* array(const char* key) const {
    const json* const list = find(key);
    if (list != nullptr && !list->is_array()) throw error(in_quotes(key) + " is no list");
    return list;
  }
  [[nodiscard]] std::int64_t count(const char* key) const {
    const json* const list = array(key);
    return list == nullptr ? 0 : static_cast<std::int64_t>(list->size());
  }
  // One of a list: `node 5` of 'nodes'.
  [[nodiscard]] Part element(const char* key, const std::string& name, std::int64_t number) const {
    const std::string place = name + " " + std::to_string(number);
    const std::int64_t size = count(key);
    if (number >= size) {
      throw refusal(place, "there is none; " + in_quotes(key) + " has " + std::to_string(size));
    }
    return {(*find(key))[static_cast<std::size_t>(number)], place};
  }

 private:
  // Nothing in a file of this format is larger than its length, which has 32 bits.
  [[nodiscard]] std::int64_t checked(const json& value, const char* key) const {
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
    if (value.is_number_unsigned() && value.get<std::uint64_t>() <= kMost) {
      return static_cast<std::int64_t>(value.get<std::uint64_t>());
    }
    throw error(in_quotes(key) + " needs whole numbers from 0 to " + std::to_string(kMost));
  }
  [[nodiscard]] Error missing(const char* key) const {
    return error(in_quotes(key) + " is missing");
  }

  const json* value_;
  std::string name_;
};

// Before anything is parsed: whoever handles the document later may do so by recursion.
void require_shallow(std::string_view text, std::size_t begin) {
  constexpr int kMostDepth = 64;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '[' || c == '{') {
      if (++depth <= kMostDepth) continue;
      throw refusal("byte " + std::to_string(begin + i),
                    "the JSON is nested deeper than " + std::to_string(kMostDepth));
    } else if (c == ']' || c == '}') {
      --depth;
    } else {
      in_string = c == '"';
    }
  }
}

json parsed(std::string_view text, std::size_t begin) {
  require_shallow(text, begin);
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    // Counted from 1; where the text ends too soon, one more than there are.
    throw refusal("byte " + std::to_string(begin + std::max<std::size_t>(error.byte, 1) - 1),
                  "the JSON cannot be read from here on");
  } catch (const json::out_of_range&) {
    throw refusal("byte " + std::to_string(begin),
                  "the JSON holds a number beyond the range of a double");
  }
}

// Those that say how a surface looks, is lit or described, not what shape it has.
bool keeps_geometry(std::string_view extension) {
  constexpr std::array<std::string_view, 12> kHarmless = {
      "KHR_animation_pointer", "KHR_lights_punctual",   "KHR_mesh_quantization",
      "KHR_texture_basisu",    "KHR_texture_transform", "KHR_xmp",
      "KHR_xmp_json_ld",       "EXT_texture_avif",      "EXT_texture_webp",
      "MSFT_texture_dds",      "KHR_techniques_webgl",  "EXT_lights_image_based"};
  return extension.starts_with("KHR_materials_") ||
         std::find(kHarmless.begin(), kHarmless.end(), extension) != kHarmless.end();
}

void require_known_extensions(const Part& root) {
  const json* const required = root.array("extensionsRequired");
  if (required == nullptr) return;
  for (const json& value : *required) {
    if (!value.is_string()) throw root.error("'extensionsRequired' needs words");
    const auto name = value.get<std::string>();
    if (keeps_geometry(name)) continue;
    if (name == "KHR_draco_mesh_compression" || name.ends_with("_meshopt_compression")) {
      throw root.error("the geometry is compressed with " + in_quotes(name) +
                       "; save it without compression");
    }
    throw root.error("the extension " + in_quotes(name) +
                     " is needed to read this file and is not known; save it without");
  }
}

Placement placement_of(const Part& node) {
  constexpr double kRounding = 1e-6;
  const auto matrix = node.numbers("matrix", 16);
  const auto translation = node.numbers("translation", 3);
  const auto rotation = node.numbers("rotation", 4);
  const auto scale = node.numbers("scale", 3);
  Placement placement = Placement::Identity();
  if (!matrix.empty()) {
    if (!translation.empty() || !rotation.empty() || !scale.empty()) {
      throw node.error("has both 'matrix' and 'translation', 'rotation' or 'scale'");
    }
    const Eigen::Map<const Eigen::Matrix4d> given(matrix.data());
    if (!(given.row(3) - Eigen::RowVector4d::Unit(3)).isZero(kRounding)) {
      throw node.error("the last row of 'matrix' is not 0 0 0 1");
    }
    placement.matrix() = given.topRows<3>();
    return placement;
  }
  if (!translation.empty()) placement.translate(Eigen::Vector3d(translation.data()));
  if (!rotation.empty()) {
    const Eigen::Vector4d turn = Eigen::Vector4d(rotation.data()).stableNormalized();
    if (turn.isZero(0.0)) throw node.error("'rotation' is 0 0 0 0");
    placement.rotate(Eigen::Quaterniond(turn));
  }
  if (!scale.empty()) placement.scale(Eigen::Vector3d(scale.data()));
  return placement;
}

GlbPrimitive primitive_of(const Part& part) {
  GlbPrimitive primitive;
  const std::int64_t mode = part.integer("mode", static_cast<int>(GlbMode::triangles));
  if (mode > static_cast<int>(GlbMode::fan)) {
    throw part.error("mode " + std::to_string(mode) + " is unknown; 0 to 6 are points to fans");
  }
  primitive.mode = static_cast<GlbMode>(mode);
  if (primitive.mode < GlbMode::triangles) return primitive;
  const json* const attributes = part.find("attributes");
  if (attributes == nullptr) throw part.error("'attributes' is missing");
  primitive.positions = Part(*attributes, part.name()).integer("POSITION");
  primitive.indices = part.integer("indices", -1);
  primitive.has_targets = part.has("targets");
  return primitive;
}

}  // namespace

struct GlbDocument::Content {
  json document;
  std::int64_t bin_size = 0;

  [[nodiscard]] Part root() const { return {document, "JSON"}; }
  // Of the buffer that a view lies in; there is but one in this file.
  [[nodiscard]] std::int64_t buffer_size(std::int64_t number) const {
    const Part buffer = root().element("buffers", "buffer", number);
    if (number > 0 || buffer.has("uri")) {
      throw buffer.error("lies outside the BIN chunk; save it as one self-contained .glb");
    }
    const std::int64_t size = buffer.integer("byteLength");
    if (size <= bin_size) return size;
    throw buffer.error(std::to_string(size) + " bytes are declared, the BIN chunk has " +
                       std::to_string(bin_size));
  }
  [[nodiscard]] GlbElements elements(const Part& accessor, std::int64_t size) const;
};

GlbElements GlbDocument::Content::elements(const Part& accessor, std::int64_t size) const {
  if (accessor.has("sparse")) throw accessor.error("is sparse; save it with all values");
  if (!accessor.has("bufferView")) {
    throw accessor.error("has no 'bufferView'; save it without compression, with all values");
  }
  const std::int64_t count = accessor.integer("count");
  const std::int64_t offset = accessor.integer("byteOffset", 0);
  const Part view = root().element("bufferViews", "bufferView", accessor.integer("bufferView"));
  const std::int64_t begin = view.integer("byteOffset", 0);
  const std::int64_t length = view.integer("byteLength");
  const std::int64_t stride = view.integer("byteStride", size);
  if (begin + length > buffer_size(view.integer("buffer"))) {
    throw view.error("goes beyond the end of its buffer");
  }
  if (stride < size) {
    throw view.error("a stride of " + std::to_string(stride) + " bytes for elements of " +
                     std::to_string(size));
  }
  if (count > 0 && (offset + size > length || count - 1 > (length - offset - size) / stride)) {
    throw accessor.error(std::to_string(count) + " elements go beyond the end of its bufferView");
  }
  return {static_cast<std::size_t>(count > 0 ? begin + offset : 0),
          static_cast<std::size_t>(stride), static_cast<std::size_t>(size), count};
}

GlbDocument::GlbDocument(std::string_view json, std::size_t json_begin, std::size_t bin_size)
    : content_(std::make_unique<Content>(
          Content{parsed(json, json_begin), static_cast<std::int64_t>(bin_size)})) {
  require_known_extensions(content_->root());
}
GlbDocument::~GlbDocument() = default;

std::int64_t GlbDocument::node_count() const { return content_->root().count("nodes"); }
std::int64_t GlbDocument::mesh_count() const { return content_->root().count("meshes"); }
bool GlbDocument::has_scenes() const { return content_->root().count("scenes") > 0; }

std::vector<std::int64_t> GlbDocument::roots() const {
  const Part root = content_->root();
  if (has_scenes()) {
    return root.element("scenes", "scene", root.integer("scene", 0)).integers("nodes");
  }
  const auto count = static_cast<std::size_t>(node_count());
  std::vector<bool> is_child(count, false);
  for (std::size_t i = 0; i < count; ++i) {
    const Part node = root.element("nodes", "node", static_cast<std::int64_t>(i));
    for (const std::int64_t child : node.integers("children")) {
      if (std::cmp_less(child, count)) is_child[static_cast<std::size_t>(child)] = true;
    }
  }
  std::vector<std::int64_t> found;
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_child[i]) found.push_back(static_cast<std::int64_t>(i));
  }
  return found;
}

GlbNode GlbDocument::node(std::int64_t number) const {
  const Part part = content_->root().element("nodes", "node", number);
  GlbNode node;
  node.children = part.integers("children");
  node.mesh = part.integer("mesh", -1);
  node.placement = placement_of(part);
  node.has_skin = part.has("skin");
  const json* const extensions = part.find("extensions");
  node.has_instances = extensions != nullptr && extensions->contains("EXT_mesh_gpu_instancing");
  return node;
}

std::vector<GlbPrimitive> GlbDocument::primitives(std::int64_t mesh) const {
  const Part part = content_->root().element("meshes", "mesh", mesh);
  std::vector<GlbPrimitive> all;
  const std::int64_t count = part.count("primitives");
  for (std::int64_t i = 0; i < count; ++i) {
    all.push_back(primitive_of(part.element("primitives", part.name() + ", primitive", i)));
  }
  return all;
}

GlbElements GlbDocument::positions(std::int64_t accessor) const {
  constexpr std::int64_t kFloat = 5126;
  const Part part = content_->root().element("accessors", "accessor", accessor);
  if (part.text("type") != "VEC3") throw part.error("positions need the type 'VEC3'");
  if (part.integer("componentType") != kFloat) {
    throw part.error(
        "positions that are not 32-bit floats (KHR_mesh_quantization); save it without "
        "quantization");
  }
  return content_->elements(part, 3 * sizeof(float));
}

GlbElements GlbDocument::indices(std::int64_t accessor) const {
  const Part part = content_->root().element("accessors", "accessor", accessor);
  if (part.text("type") != "SCALAR") throw part.error("indices need the type 'SCALAR'");
  switch (part.integer("componentType")) {
    case 5121:
      return content_->elements(part, sizeof(std::uint8_t));
    case 5123:
      return content_->elements(part, sizeof(std::uint16_t));
    case 5125:
      return content_->elements(part, sizeof(std::uint32_t));
    default:
      throw part.error("indices need unsigned integers: componentType 5121, 5123 or 5125");
  }
}

}  // namespace timbre::detail

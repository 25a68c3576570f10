// Any bytes under any name: a mesh or one line, and the same whether a reader sees the whole
// file or its first bytes.
#include <array>
#include <optional>
#include <string>

#include "timbre/analysis/mesh/detail/formats.h"
#include "timbre/analysis/mesh/read_mesh.h"
#include "timbre/tests/fuzz/target.h"

namespace timbre::fuzz {
namespace {

using detail::FileFormat;

struct Verdict {
  bool refused = false;
  std::optional<FileFormat> format;
};

Verdict verdict_on(std::string_view head, std::uint64_t size, const std::string& name) {
  try {
    return {.refused = false, .format = detail::detect_format(head, size, name)};
  } catch (const Error& error) {
    require_plain(error, ErrorKind::bad_input);
    return {.refused = true, .format = {}};
  }
}

// A reader looks at the first bytes to refuse early; it must not refuse what it would read.
void require_head_tells_nothing_else(std::string_view input, const std::string& name) {
  const Verdict whole = verdict_on(input, input.size(), name);
  require(whole.refused || whole.format, "the whole file tells its format");
  for (const std::size_t size : {std::size_t{84}, std::size_t{100}, std::size_t{300}}) {
    if (size >= input.size()) break;
    const Verdict head = verdict_on(input.substr(0, size), input.size(), name);
    require(whole.refused || !head.refused, "the head refuses nothing that the whole is");
    require(whole.refused || !head.format || head.format == whole.format,
            "the head tells the same format");
  }
}

}  // namespace

void examine(std::string_view input) {
  static const std::array<std::string, 8> kNames = {"m",     "m.off", "m.obj",    "m.ply",
                                                    "m.stl", "m.gz",  "m.stl.gz", "-"};
  for (const std::string& name : kNames) {
    if (!name.ends_with(".gz")) require_head_tells_nothing_else(input, name);
    try {
      const MeshFile file = read_mesh_bytes(input, name);
      require(!file.format.empty(), "a mesh has a format");
      require(file.mesh.vertices.allFinite(), "coordinates are finite");
    } catch (const Error& error) {
      require_plain(error, ErrorKind::bad_input);
    }
  }
}

}  // namespace timbre::fuzz

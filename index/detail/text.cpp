#include "timbre/index/detail/text.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "timbre/analysis/core/error.h"

namespace timbre::detail {
namespace {

// Length of a sequence by its first byte, and the least code point of that length.
struct Lead {
  unsigned char mask, bits;
  std::size_t length;
  std::uint32_t least;
};
constexpr std::array<Lead, 4> kLeads = {{{0x80, 0x00, 1, 0x0},
                                         {0xe0, 0xc0, 2, 0x80},
                                         {0xf0, 0xe0, 3, 0x800},
                                         {0xf8, 0xf0, 4, 0x10000}}};

}  // namespace

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const auto first = static_cast<unsigned char>(text[0]);
    const auto* const lead = std::find_if(
        kLeads.begin(), kLeads.end(), [&](const Lead& l) { return (first & l.mask) == l.bits; });
    if (lead == kLeads.end() || text.size() < lead->length) return false;
    std::uint32_t point = first & static_cast<unsigned char>(~lead->mask);
    for (std::size_t i = 1; i < lead->length; ++i) {
      const auto byte = static_cast<unsigned char>(text[i]);
      if ((byte & 0xc0) != 0x80) return false;
      point = point << 6 | (byte & 0x3fU);
    }
    const bool surrogate = point >= 0xd800 && point < 0xe000;
    if (point < lead->least || point > 0x10ffff || surrogate) return false;
    text.remove_prefix(lead->length);
  }
  return true;
}

void require_local(const std::string& location) {
  if (location.find("://") != std::string::npos) {
    throw Error(ErrorKind::bad_request, location, "", "only local files can be opened");
  }
}

}  // namespace timbre::detail

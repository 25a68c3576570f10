#include "timbre/index/channel.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "timbre/analysis/core/error.h"

// Each channel is defined in channels/NAME.cpp as make_NAME().
#define TIMBRE_CHANNELS(X) \
  X(dna_i)                 \
  X(dna_log)               \
  X(dna_raw)               \
  X(dna_weyl)              \
  X(dna_wesd)              \
  X(gps_q)

namespace timbre {
namespace detail {

#define TIMBRE_DECLARE(name) Channel make_##name();
TIMBRE_CHANNELS(TIMBRE_DECLARE)
#undef TIMBRE_DECLARE

}  // namespace detail

std::string canonical_text(const Parameters& parameters) {
  std::string text;
  for (const auto& [key, value] : parameters) {
    if (!text.empty()) text += ' ';
    text.append(key).append(1, '=').append(value);
  }
  return text;
}

const std::vector<Channel>& channels() {
#define TIMBRE_MAKE(name) detail::make_##name(),
  static const std::vector<Channel> all = {TIMBRE_CHANNELS(TIMBRE_MAKE)};
#undef TIMBRE_MAKE
  return all;
}

const Channel& find_channel(const std::string& name) {
  std::string names;
  for (const Channel& channel : channels()) {
    if (channel.name == name) return channel;
    names.append(names.empty() ? "" : ", ").append(channel.name);
  }
  throw Error(ErrorKind::bad_request, "", "channel",
              "there is no '" + name + "'; there are " + names);
}

double mean_absolute_difference(std::span<const double> a, std::span<const double> b) {
  const std::size_t shared = std::min(a.size(), b.size());
  if (shared == 0) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (std::size_t i = 0; i < shared; ++i) sum += std::abs(a[i] - b[i]);
  return sum / static_cast<double>(shared);
}

double euclidean_distance(std::span<const double> a, std::span<const double> b) {
  const std::size_t shared = std::min(a.size(), b.size());
  if (shared == 0) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (std::size_t i = 0; i < shared; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

}  // namespace timbre

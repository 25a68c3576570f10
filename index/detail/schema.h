#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/sha256.h"
#include "timbre/index/detail/sqlite.h"
#include "timbre/index/store.h"

namespace timbre::detail {

/// Number and combined digest of all shape rows: changes with every row, whatever their
/// order, so that a row that got lost or doubled is noticed.
struct Roster {
  std::int64_t count = 0;
  Sha256Digest sum{};  ///< exclusive or of the rows' digests

  void put_in(const Sha256Digest& row);
  void take_out(const Sha256Digest& row);
  bool operator==(const Roster&) const = default;
};

/// Makes a whole empty database at `path`, or nothing.
void create_database(const std::string& path, const StoreParameters& parameters);

/// Opens and makes sure that it is one of ours, of a version we know, with our tables.
[[nodiscard]] Database open_database(const std::string& path, StoreAccess access);

[[nodiscard]] StoreParameters read_parameters(const Database& database);
[[nodiscard]] Roster read_roster(const Database& database);
void write_roster(const Database& database, const Roster& roster);

/// What a checksum that differs is told as.
[[nodiscard]] Error damaged(const std::string& path, const std::string& place);

}  // namespace timbre::detail

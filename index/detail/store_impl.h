#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/index/detail/records.h"
#include "timbre/index/detail/schema.h"
#include "timbre/index/detail/sqlite.h"
#include "timbre/index/store.h"

namespace timbre {

// Rows of the database. All functions suppose that a transaction is open.
struct Store::Impl {
  detail::Database database;
  StoreParameters parameters;
  std::string parameters_text;

  struct Row {
    ShapeInfo info;
    std::int64_t blobs = 0;
    Sha256Digest digest{};
  };

  [[nodiscard]] Error error(const std::string& place, const std::string& cause,
                            ErrorKind kind = ErrorKind::bad_input) const;

  [[nodiscard]] Row checked_row(const detail::Statement& row) const;

  void for_each_row(const std::function<void(const detail::Statement&)>& visit) const;

  [[nodiscard]] std::vector<ShapeInfo> list() const;

  [[nodiscard]] std::optional<Row> look_up(const std::string& name) const;

  /// A damaged search tree can hide a row. Before saying no, the whole list is checked.
  [[nodiscard]] std::optional<ShapeInfo> find(const std::string& name) const;

  [[nodiscard]] ShapeInfo require(const std::string& name) const;

  /// Columns: version, parameters, bytes, sha256, from `first` on.
  [[nodiscard]] detail::Blob checked_blob(const ShapeInfo& shape, const std::string& channel,
                                          const detail::Statement& row, int first) const;

  [[nodiscard]] detail::Blob read_blob(const ShapeInfo& shape, const std::string& channel) const;

  [[nodiscard]] Error missing_blob(const ShapeInfo& shape, const std::string& channel) const;

  [[nodiscard]] std::string full_parameters(Parameters own) const;

  void require_same_meaning(const detail::Blob& blob, const Channel& channel) const;

  void write_blob(const ShapeInfo& shape, const detail::Blob& blob) const;

  [[nodiscard]] std::vector<detail::Blob> blobs_of(const ShapeRecord& record) const;

  void insert(ShapeInfo shape, const std::vector<detail::Blob>& blobs,
              detail::Roster& roster) const;

  void erase(const Row& row, detail::Roster& roster) const;

  /// From one to the next through the key, without reading what lies between.
  [[nodiscard]] std::vector<std::string> stored_channels() const;
};

}  // namespace timbre

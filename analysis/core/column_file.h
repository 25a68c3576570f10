#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "timbre/analysis/core/array_file.h"

namespace timbre {

/// The `.npy` file of a matrix whose columns come little by little, over several runs if need be.
/// Until `commit` its name is that of `unfinished`.
class ColumnFile {
 public:
  /// Reserves the whole file. With `resume` the unfinished file is opened again, and keeps its
  /// columns.
  /// @throws Error  io, as when the disk is too small; bad_input with `resume` if the unfinished
  ///                file is not there or was begun for another matrix
  ColumnFile(const std::string& path, Eigen::Index rows, Eigen::Index cols, ElementType type,
             bool resume);
  ~ColumnFile();
  ColumnFile(const ColumnFile&) = delete;
  ColumnFile& operator=(const ColumnFile&) = delete;

  /// Writes columns [first, first + columns.cols()); they outlive a crash once it returns.
  /// @throws Error  io
  void write(Eigen::Index first, const Eigen::MatrixXd& columns);

  /// Gives the file its name; once, and last.
  /// @throws Error  io; bad_request if a file of that name is there and not to be replaced
  void commit(bool overwrite);

  /// The name until then, beside the file that a link leads to.
  [[nodiscard]] static std::string unfinished(const std::string& path);

 private:
  void begin(const std::string& header, std::int64_t size);
  void reopen(const std::string& header, std::int64_t size);
  void write_at(std::int64_t place, const char* data, std::size_t size) const;

  std::string path_;
  Eigen::Index rows_;
  ElementType type_;
  std::int64_t header_size_ = 0;
  int descriptor_ = -1;
};

}  // namespace timbre

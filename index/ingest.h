#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "timbre/analysis/core/progress.h"
#include "timbre/analysis/mesh/read_mesh.h"
#include "timbre/index/store.h"

namespace timbre {

struct IngestInput {
  std::string path;   ///< a mesh file, or - for standard input
  std::string name;   ///< empty: taken from the path
  std::string label;  ///< empty: none
};

struct IngestOptions {
  bool replace = false;  ///< put other content or another label in place of what is there
  int threads = 0;       ///< meshes worked on at a time; 0: all cores
  /// Bytes that meshes solved at a time may take, by their size; a larger one goes alone.
  /// 0: three quarters of what the system has free
  std::int64_t memory = 0;
  Progress progress = {};  ///< counts inputs; may be empty
  ReadOptions read = {};   ///< of the mesh files
};

struct IngestResult {
  std::string path;
  std::string name;
  std::optional<AddOutcome> outcome;  ///< empty: refused, and `error` says why
  std::string error;                  ///< one line, with the file's name
  std::vector<ReadWarning> warnings;  ///< of reading the file
};

struct IngestSummary {
  std::int64_t added = 0;
  std::int64_t kept = 0;
  std::int64_t replaced = 0;
  std::int64_t failed = 0;
};

/// Reads, solves and stores mesh files.
///
/// Threads solve one mesh each, as many as `memory` allows; the caller's thread stores them in the
/// order of `inputs`, so that the database does not depend on the number of threads. At most two
/// meshes per thread are held in memory. A file that cannot be read or solved is reported and the
/// others go on. Of a shape that is there already only the file is read.
///
/// @param on_result  called in the order of `inputs`; what it hears of is durable
/// @throws Error  io when the database cannot be written; cancelled. What was reported
///                before stays stored.
IngestSummary add_files(Store& store, const std::vector<IngestInput>& inputs,
                        const IngestOptions& options,
                        const std::function<void(const IngestResult&)>& on_result);

}  // namespace timbre

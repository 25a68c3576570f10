#include "timbre/index/ingest.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include "timbre/analysis/core/byte_source.h"
#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/memory_budget.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/index/features.h"
#include "timbre/index/labels.h"

namespace timbre {
namespace {

using KnownContent = std::map<std::string, std::pair<Sha256Digest, std::string>>;

// What a thread has made of one input.
struct Computed {
  IngestResult result;
  ShapeRecord record;
  bool solved = false;         ///< false: the store knew it, or `result.error` says why not
  std::exception_ptr failure;  ///< nothing to do with the file: ends the whole
};

// Results of numbered tasks, worked on by several threads, taken in order by one.
class OrderedPipeline {
 public:
  OrderedPipeline(std::size_t count, int threads, std::function<Computed(std::size_t)> work)
      : count_(count), window_(2 * static_cast<std::size_t>(threads)), work_(std::move(work)) {
    for (int t = 0; t < threads; ++t) threads_.emplace_back([this] { run(); });
  }
  ~OrderedPipeline() {
    stopping_ = true;
    { const std::lock_guard lock(mutex_); }
    room_.notify_all();
  }
  OrderedPipeline(const OrderedPipeline&) = delete;
  OrderedPipeline& operator=(const OrderedPipeline&) = delete;

  /// The next result, or nothing after a tenth of a second without one.
  std::optional<Computed> take() {
    std::unique_lock lock(mutex_);
    const auto is_there = [this] { return !done_.empty() && done_.begin()->first == taken_; };
    if (!ready_.wait_for(lock, std::chrono::milliseconds(100), is_there)) return std::nullopt;
    Computed computed = std::move(done_.begin()->second);
    done_.erase(done_.begin());
    ++taken_;
    lock.unlock();
    room_.notify_all();
    return computed;
  }

 private:
  void run() {
    for (;;) {
      std::unique_lock lock(mutex_);
      room_.wait(lock,
                 [this] { return stopping_ || started_ == count_ || started_ < taken_ + window_; });
      if (stopping_ || started_ == count_) return;
      const std::size_t task = started_++;
      lock.unlock();
      Computed computed = work_(task);
      lock.lock();
      done_.emplace(task, std::move(computed));
      lock.unlock();
      ready_.notify_one();
    }
  }

  std::size_t count_, window_;
  std::function<Computed(std::size_t)> work_;
  std::atomic<bool> stopping_ = false;
  std::mutex mutex_;
  std::condition_variable room_, ready_;
  std::map<std::size_t, Computed> done_;
  std::size_t started_ = 0, taken_ = 0;
  std::vector<std::jthread> threads_;  // last: joined before what they use goes
};

std::string line_of(const Error& error, const std::string& path) {
  return error.file().empty() ? error.in_file(path).what() : error.what();
}

// What compute() needs besides its input; the same for all.
struct Task {
  StoreParameters parameters;
  const KnownContent& known;
  const IngestOptions& options;
  Progress keep_going;
  int threads;  // of one mesh
  MemoryBudget& memory;
};

// Nodes of the operator for each vertex of a mesh, about.
std::int64_t nodes_per_vertex(OperatorKind kind) {
  return kind == OperatorKind::p3 ? 9 : kind == OperatorKind::p2 ? 4 : 1;
}

// Waiting for standard input ends when the whole is stopped.
MeshFile read(const std::string& path, const Task& task) {
  if (path != "-") return read_mesh(path, task.options.read);
  const std::string bytes = read_bytes(path, {.size_limit = task.options.read.size_limit,
                                              .stop = [&] { return !task.keep_going({}); }});
  return read_mesh_bytes(bytes, path, task.options.read);
}

void read_and_solve(const IngestInput& input, const Task& task, Computed& computed) {
  const std::string& name = computed.result.name;
  if (name.empty()) throw Error(ErrorKind::bad_input, "", "name", "is empty; --name gives one");
  require_storable_text(name, "name");
  require_storable_text(input.label, "label");
  MeshFile file = read(input.path, task);
  computed.result.warnings = std::move(file.warnings);
  const auto entry = task.known.find(name);
  if (entry != task.known.end() && entry->second.first == content_of(file.mesh) &&
      (!task.options.replace || entry->second.second == input.label)) {
    computed.result.outcome = AddOutcome::kept;
    if (!input.label.empty() && entry->second.second != input.label) {
      computed.result.warnings.push_back(
          {"label-kept", 1, "keeps its label '" + entry->second.second + "' without --replace"});
    }
    return;
  }
  const auto share = task.memory.take(
      expected_memory(file.mesh.vertices.rows() * nodes_per_vertex(task.parameters.operator_kind),
                      task.parameters.count));
  computed.record = compute_record(name, input.label, std::move(file.mesh), task.parameters,
                                   task.keep_going, task.threads);
  computed.solved = true;
}

Computed compute(const IngestInput& input, const Task& task) {
  Computed computed;
  computed.result.path = input.path;
  if (!input.name.empty()) {
    computed.result.name = input.name;
  } else if (input.path != "-") {
    computed.result.name = shape_name_of(input.path);
  }
  try {
    read_and_solve(input, task, computed);
  } catch (const Error& error) {
    computed.result.error = line_of(error, input.path);
  } catch (const std::bad_alloc&) {
    computed.result.error =
        Error(ErrorKind::io, input.path, "memory", "not enough for this mesh").what();
  } catch (...) {
    computed.failure = std::current_exception();
  }
  return computed;
}

// A name that is taken concerns one file; all else that fails here concerns the database.
void put_in(Store& store, Computed& computed, bool replace) {
  if (!computed.solved) return;
  try {
    computed.result.outcome = store.add(computed.record, replace);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::bad_request) throw;
    computed.result.error = error.what();
  }
}

void count(IngestSummary& summary, const std::optional<AddOutcome>& outcome) {
  if (!outcome) {
    ++summary.failed;
  } else if (*outcome == AddOutcome::added) {
    ++summary.added;
  } else if (*outcome == AddOutcome::kept) {
    ++summary.kept;
  } else {
    ++summary.replaced;
  }
}

}  // namespace

IngestSummary add_files(Store& store, const std::vector<IngestInput>& inputs,
                        const IngestOptions& options,
                        const std::function<void(const IngestResult&)>& on_result) {
  IngestSummary summary;
  KnownContent known;
  for (ShapeInfo& shape : store.list()) {
    known[std::move(shape.name)] = {shape.content, std::move(shape.label)};
  }
  const SingleThreadedBlas blas;
  const int wanted = options.threads > 0 ? options.threads : hardware_threads();
  const int threads = static_cast<int>(std::min(inputs.size(), static_cast<std::size_t>(wanted)));
  std::atomic<bool> stop = false;
  MemoryBudget memory(options.memory > 0 ? options.memory : available_memory() / 4 * 3);
  const Task task{
      store.parameters(),       known, options, [&stop](const ProgressStep&) { return !stop; },
      threads > 1 ? 1 : wanted, memory};
  struct StopOnLeaving {
    std::atomic<bool>& flag;
    ~StopOnLeaving() { flag = true; }
  };
  OrderedPipeline pipeline(inputs.size(), threads,
                           [&](std::size_t i) { return compute(inputs[i], task); });
  const StopOnLeaving stop_on_leaving{stop};
  ProgressReporter reporter(options.progress, "shapes", static_cast<std::int64_t>(inputs.size()));
  for (std::size_t done = 0; done < inputs.size();) {
    reporter.advance_to(static_cast<std::int64_t>(done));
    std::optional<Computed> computed = pipeline.take();
    if (!computed) continue;
    if (computed->failure) std::rethrow_exception(computed->failure);
    put_in(store, *computed, options.replace);
    count(summary, computed->result.outcome);
    on_result(computed->result);
    ++done;
  }
  return summary;
}

}  // namespace timbre

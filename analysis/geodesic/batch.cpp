#include "timbre/analysis/geodesic/batch.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <string>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/analysis/geodesic/exact.h"
#include "timbre/analysis/geodesic/heat.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using SourceSets = std::span<const std::vector<std::int32_t>>;

constexpr Index kBlockBytes = Index{64} << 20;

// Fills the columns of some source sets.
class ColumnFiller {
 public:
  virtual ~ColumnFiller() = default;
  virtual void fill(SourceSets sets, MatrixXd& columns, SharedProgress& progress) = 0;
};

class ExactFiller final : public ColumnFiller {
 public:
  ExactFiller(const TriangleMesh& mesh, int threads)
      : mesh_(make_geodesic_mesh(mesh)), threads_(threads) {}

  void fill(SourceSets sets, MatrixXd& columns, SharedProgress& progress) override {
    parallel_for(columns.cols(), threads_, [&](std::int64_t i) {
      std::unique_ptr<ExactGeodesics> worker = take();
      const auto go_on = [&progress] {
        progress.tell();
        return true;
      };
      columns.col(i) = worker->distances(sets[static_cast<std::size_t>(i)], {.keep_going = go_on});
      give_back(std::move(worker));
      progress.finish_one();
    });
  }

 private:
  std::unique_ptr<ExactGeodesics> take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<ExactGeodesics>(mesh_);
    std::unique_ptr<ExactGeodesics> worker = std::move(idle_.back());
    idle_.pop_back();
    return worker;
  }
  void give_back(std::unique_ptr<ExactGeodesics> worker) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(worker));
  }

  GeodesicMesh mesh_;
  int threads_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<ExactGeodesics>> idle_;
};

class GraphFiller final : public ColumnFiller {
 public:
  GraphFiller(const TriangleMesh& mesh, int threads)
      : graph_(make_geodesic_graph(mesh)), threads_(threads) {}

  void fill(SourceSets sets, MatrixXd& columns, SharedProgress& progress) override {
    parallel_for(columns.cols(), threads_, [&](std::int64_t i) {
      columns.col(i) = graph_distances(graph_, sets[static_cast<std::size_t>(i)]);
      progress.finish_one();
    });
  }

 private:
  GeodesicGraph graph_;
  int threads_;
};

class HeatFiller final : public ColumnFiller {
 public:
  HeatFiller(const TriangleMesh& mesh, const DistanceOptions& options)
      : heat_(mesh, {.time_factor = options.time_factor}), threads_(options.threads) {}

  void fill(SourceSets sets, MatrixXd& columns, SharedProgress& progress) override {
    const auto few = static_cast<std::size_t>(threads_ > 0 ? threads_ : hardware_threads());
    for (std::size_t begin = 0; begin < sets.size(); begin += few) {
      const SourceSets part = sets.subspan(begin, std::min(few, sets.size() - begin));
      columns.middleCols(static_cast<Index>(begin), std::ssize(part)) =
          heat_.distances(part, threads_);
      for (std::size_t i = 0; i < part.size(); ++i) progress.finish_one();
    }
  }

 private:
  HeatGeodesics heat_;
  int threads_;
};

std::unique_ptr<ColumnFiller> make_filler(const TriangleMesh& mesh,
                                          const DistanceOptions& options) {
  if (options.method == DistanceMethod::heat) return std::make_unique<HeatFiller>(mesh, options);
  if (options.method == DistanceMethod::graph) {
    return std::make_unique<GraphFiller>(mesh, options.threads);
  }
  return std::make_unique<ExactFiller>(mesh, options.threads);
}

void require_sources(SourceSets sets, Index vertices) {
  for (const auto& sources : sets) {
    for (const std::int32_t v : sources) {
      if (v >= 0 && v < vertices) continue;
      throw Error(ErrorKind::bad_request, "", "sources",
                  "vertex " + std::to_string(v) + " does not exist; the mesh has " +
                      std::to_string(vertices));
    }
  }
}

}  // namespace

void compute_distances(const TriangleMesh& mesh, SourceSets source_sets, const DistanceSink& sink,
                       const DistanceOptions& options) {
  const Index n = mesh.vertices.rows();
  require_sources(source_sets, n);
  const Index count = std::ssize(source_sets);
  if (count == 0) return;
  SharedProgress progress(options.progress, "distances", count);
  progress.tell();
  const std::unique_ptr<ColumnFiller> filler = make_filler(mesh, options);
  const Index threads = options.threads > 0 ? options.threads : hardware_threads();
  const Index bytes = n * static_cast<Index>(sizeof(double));
  const Index block = std::max(kBlockBytes / std::max<Index>(bytes, 1), threads);
  MatrixXd columns;
  for (Index first = 0; first < count; first += block) {
    columns.resize(n, std::min(block, count - first));
    filler->fill(source_sets.subspan(static_cast<std::size_t>(first),
                                     static_cast<std::size_t>(columns.cols())),
                 columns, progress);
    sink(first, columns);
  }
}

MatrixXd compute_distances(const TriangleMesh& mesh, SourceSets source_sets,
                           const DistanceOptions& options) {
  MatrixXd result(mesh.vertices.rows(), std::ssize(source_sets));
  compute_distances(
      mesh, source_sets,
      [&result](Index first, const Eigen::Ref<const MatrixXd>& columns) {
        result.middleCols(first, columns.cols()) = columns;
      },
      options);
  return result;
}

const char* to_word(DistanceMethod method) {
  switch (method) {
    case DistanceMethod::heat:
      return "heat";
    case DistanceMethod::graph:
      return "graph";
    case DistanceMethod::exact:
      break;
  }
  return "exact";
}

}  // namespace timbre

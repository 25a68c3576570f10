// How long do distances from one vertex take, and how far off are they?
//
//   cmake --preset release -DTIMBRE_BENCHMARKS=ON
//   cmake --build build/release --target geodesic_benchmark
//   build/release/benchmarks/geodesic_benchmark
//
// `error` is the mean relative error against great circles. The peer is what one would write
// in an afternoon: Dijkstra's algorithm over the edges.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "timbre/analysis/geodesic/batch.h"
#include "timbre/analysis/geodesic/exact.h"
#include "timbre/analysis/geodesic/graph.h"
#include "timbre/analysis/geodesic/heat.h"
#include "timbre/datasets/analytic.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// 10 f^2 + 2 vertices.
TriangleMesh sphere_of(const benchmark::State& state) {
  return make_sphere(static_cast<int>(state.range(0)));
}

void report(benchmark::State& state, const TriangleMesh& sphere, const VectorXd& found,
            Index source) {
  double sum = 0.0;
  for (Index v = 0; v < found.size(); ++v) {
    if (v == source) continue;
    const double cosine = sphere.vertices.row(v).dot(sphere.vertices.row(source));
    sum += std::abs(found[v] / std::acos(std::clamp(cosine, -1.0, 1.0)) - 1.0);
  }
  state.counters["error"] = sum / static_cast<double>(found.size() - 1);
  state.counters["vertices"] = static_cast<double>(found.size());
}

struct Edge {
  std::int32_t to = 0;
  double length = 0.0;
};
using EdgeLists = std::vector<std::vector<Edge>>;

EdgeLists edges_of(const TriangleMesh& mesh) {
  EdgeLists edges(static_cast<std::size_t>(mesh.vertices.rows()));
  for (const auto& face : mesh.faces.rowwise()) {
    for (int c = 0; c < 3; ++c) {
      const std::int32_t a = face[c];
      const std::int32_t b = face[(c + 1) % 3];
      edges[static_cast<std::size_t>(a)].push_back(
          {b, (mesh.vertices.row(a) - mesh.vertices.row(b)).norm()});
    }
  }
  return edges;  // closed and oriented: each edge comes once from either side
}

VectorXd dijkstra(const EdgeLists& edges, std::int32_t source) {
  using Entry = std::pair<double, std::int32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  VectorXd distance =
      VectorXd::Constant(std::ssize(edges), std::numeric_limits<double>::infinity());
  distance[source] = 0.0;
  queue.emplace(0.0, source);
  while (!queue.empty()) {
    const auto [reached, v] = queue.top();
    queue.pop();
    if (reached > distance[v]) continue;
    for (const Edge& edge : edges[static_cast<std::size_t>(v)]) {
      const double through = reached + edge.length;
      if (through >= distance[edge.to]) continue;
      distance[edge.to] = through;
      queue.emplace(through, edge.to);
    }
  }
  return distance;
}

void peer_dijkstra_over_edges(benchmark::State& state) {
  const TriangleMesh sphere = sphere_of(state);
  const EdgeLists edges = edges_of(sphere);
  VectorXd found;
  for (auto _ : state) benchmark::DoNotOptimize(found = dijkstra(edges, 5));
  report(state, sphere, found, 5);
}
BENCHMARK(peer_dijkstra_over_edges)->Arg(32)->Arg(100)->Unit(benchmark::kMillisecond);

void graph(benchmark::State& state) {
  const TriangleMesh sphere = sphere_of(state);
  const GeodesicGraph prepared = make_geodesic_graph(sphere);
  VectorXd found;
  for (auto _ : state) benchmark::DoNotOptimize(found = graph_distances(prepared, {5}));
  report(state, sphere, found, 5);
}
BENCHMARK(graph)->Arg(32)->Arg(100)->Unit(benchmark::kMillisecond);

void exact_prepare(benchmark::State& state) {
  const TriangleMesh sphere = sphere_of(state);
  for (auto _ : state) benchmark::DoNotOptimize(make_geodesic_mesh(sphere));
}
BENCHMARK(exact_prepare)->Arg(32)->Arg(100)->Unit(benchmark::kMillisecond);

void exact(benchmark::State& state) {
  const TriangleMesh sphere = sphere_of(state);
  const GeodesicMesh prepared = make_geodesic_mesh(sphere);
  ExactGeodesics geodesics(prepared);
  VectorXd found;
  for (auto _ : state) benchmark::DoNotOptimize(found = geodesics.distances({{5}}));
  report(state, sphere, found, 5);
}
BENCHMARK(exact)->Arg(32)->Arg(100)->Unit(benchmark::kMillisecond);

// From each vertex in turn to three that are `range(1)` numbers on in a torus of 100 x 50
// vertices: next to it, and some edges away.
void exact_to_targets(benchmark::State& state) {
  const GeodesicMesh prepared = make_geodesic_mesh(make_torus(2.0, 0.7, 100, 50));
  ExactGeodesics geodesics(prepared);
  std::int32_t source = 0;
  for (auto _ : state) {
    const auto away = [&](int times) {
      return (source + times * static_cast<std::int32_t>(state.range(0))) % 5000;
    };
    benchmark::DoNotOptimize(geodesics.distances_to({{source}}, {{away(1), away(2), away(3)}}));
    source = (source + 7) % 5000;
  }
}
BENCHMARK(exact_to_targets)->Arg(1)->Arg(51)->Arg(204)->Unit(benchmark::kMicrosecond);

void heat_prepare(benchmark::State& state) {
  const TriangleMesh sphere = sphere_of(state);
  for (auto _ : state) benchmark::DoNotOptimize(HeatGeodesics(sphere));
}
BENCHMARK(heat_prepare)->Arg(100)->Unit(benchmark::kMillisecond);

void heat_100_sources(benchmark::State& state) {
  const TriangleMesh sphere = sphere_of(state);
  HeatGeodesics geodesics(sphere);
  std::vector<std::vector<std::int32_t>> sources;
  for (std::int32_t i = 0; i < 100; ++i) {
    sources.push_back({static_cast<std::int32_t>(sphere.vertices.rows() / 100) * i + 5});
  }
  Eigen::MatrixXd found;
  for (auto _ : state) benchmark::DoNotOptimize(found = geodesics.distances(sources, 1));
  report(state, sphere, found.col(0), 5);
}
BENCHMARK(heat_100_sources)->Arg(100)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace timbre

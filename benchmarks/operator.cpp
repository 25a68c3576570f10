// How long does it take to assemble the Laplacian of a million triangles?
//
//   cmake --preset release -DTIMBRE_BENCHMARKS=ON
//   cmake --build build/release --target operator_benchmark
//   build/release/benchmarks/operator_benchmark
//
// The peer is geometry-central's tufted Laplacian, which is that of robust-laplacian for Python:
// add -DTIMBRE_GEOMETRY_CENTRAL=FOLDER, a checkout with its submodules, to the first line. Both
// get arrays of vertices and faces and give both matrices. `turned`: faces turned at random, as
// in a triangle soup, so that one sheet does not do and the whole cover is flipped.
#include <benchmark/benchmark.h>

#include <random>
#include <utility>

#include "timbre/analysis/operators/operator.h"
#include "timbre/datasets/analytic.h"

#ifdef TIMBRE_GEOMETRY_CENTRAL
#include <geometrycentral/surface/surface_mesh_factories.h>
#include <geometrycentral/surface/tufted_laplacian.h>
#endif

namespace timbre {
namespace {

// Stretched: about every second triangle needs a flip.
TriangleMesh body(const benchmark::State& state) {
  TriangleMesh mesh = make_ellipsoid(1.0, 0.5, 4.0, static_cast<int>(state.range(0)));
  if (state.range(1) == 0) return mesh;
  std::mt19937 random(1);
  for (auto face : mesh.faces.rowwise()) {
    if (random() % 2 == 0) std::swap(face[1], face[2]);
  }
  return mesh;
}

void run(benchmark::State& state, OperatorKind kind) {
  const TriangleMesh mesh = body(state);
  Operator op;
  for (auto _ : state) {
    op = compute_operator(mesh, {.kind = kind});
    benchmark::DoNotOptimize(op.stiffness.valuePtr());
  }
  state.counters["faces"] = static_cast<double>(mesh.faces.rows());
  state.counters["flips"] = static_cast<double>(op.flips);
}

void Robust(benchmark::State& state) { run(state, OperatorKind::robust); }
void Cotan(benchmark::State& state) { run(state, OperatorKind::cotan); }

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"frequency", "turned"})->Unit(benchmark::kMillisecond);
  for (const int frequency : {71, 224}) {  // 100,000 and 1,000,000 triangles
    for (const int turned : {0, 1}) benchmark->Args({frequency, turned});
  }
}

BENCHMARK(Robust)->Apply(sizes);
BENCHMARK(Cotan)->Apply(sizes);

#ifdef TIMBRE_GEOMETRY_CENTRAL
void GeometryCentral(benchmark::State& state) {
  namespace peer = geometrycentral::surface;
  const TriangleMesh mesh = body(state);
  for (auto _ : state) {
    const auto [surface, geometry] =
        peer::makeSurfaceMeshAndGeometry(mesh.vertices, mesh.faces.cast<std::size_t>().eval());
    auto [stiffness, mass] = peer::buildTuftedLaplacian(*surface, *geometry, 1e-5);
    benchmark::DoNotOptimize(stiffness.valuePtr());
  }
  state.counters["faces"] = static_cast<double>(mesh.faces.rows());
}
BENCHMARK(GeometryCentral)->Apply(sizes);
#endif

}  // namespace
}  // namespace timbre

// How fast are meshes read from files?
//
//   cmake --preset release -DTIMBRE_BENCHMARKS=ON
//   cmake --build build/release --target readers_benchmark
//   build/release/benchmarks/readers_benchmark [FILE...]
//
// Each file is read by timbre and by the peers that know its format: OpenMesh into its half-edge
// mesh, assimp without post-processing. All of it counts: opening, parsing, checks, the mesh as
// the library gives it. The files lie in the system's cache after the first round. Without names
// an ellipsoid of 2 million triangles is written in some formats, and removed in the end.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <assimp/Importer.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "timbre/analysis/mesh/read_mesh.h"
#include "timbre/analysis/mesh/write_mesh.h"
#include "timbre/datasets/analytic.h"

namespace timbre {
namespace {

namespace fs = std::filesystem;

template <typename Read>
void time_reader(const std::string& reader, const fs::path& file, Read read) {
  const std::string path = file.string();
  const auto run = [=](benchmark::State& state) {
    for (auto _ : state) {
      if (!read(path)) {
        state.SkipWithError("does not read it");
        return;
      }
    }
    const auto bytes = static_cast<std::int64_t>(fs::file_size(path));
    state.SetBytesProcessed(state.iterations() * bytes);
  };
  benchmark::RegisterBenchmark((file.filename().string() + "/" + reader).c_str(), run)
      ->Unit(benchmark::kMillisecond)
      ->MinTime(2.0);
}

bool read_by_timbre(const std::string& path) {
  const MeshFile file = read_mesh(path);
  benchmark::DoNotOptimize(file.mesh.faces.data());
  return true;
}

bool read_by_openmesh(const std::string& path) {
  OpenMesh::TriMesh_ArrayKernelT<> mesh;
  OpenMesh::IO::Options options;
  return OpenMesh::IO::read_mesh(mesh, path, options);
}

bool read_by_assimp(const std::string& path) {
  Assimp::Importer importer;
  return importer.ReadFile(path, 0) != nullptr;
}

void time_readers(const fs::path& file) {
  time_reader("timbre", file, read_by_timbre);
  time_reader("OpenMesh", file, read_by_openmesh);
  time_reader("assimp", file, read_by_assimp);
}

std::vector<fs::path> write_examples(const fs::path& folder) {
  const TriangleMesh mesh = make_ellipsoid(1.0, 0.5, 2.0, 316);
  std::vector<fs::path> files;
  fs::create_directory(folder);
  for (const char* const name :
       {"ellipsoid.off", "ellipsoid.obj", "ellipsoid.ply", "ellipsoid.stl", "ellipsoid.glb"}) {
    files.push_back(folder / name);
    write_mesh(mesh, files.back().string(), true);
  }
  return files;
}

}  // namespace
}  // namespace timbre

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("readers_benchmark_" + std::to_string(getpid()));
  std::vector<std::filesystem::path> files(argv + 1, argv + argc);
  if (files.empty()) files = timbre::write_examples(folder);
  for (const auto& file : files) timbre::time_readers(file);
  benchmark::RunSpecifiedBenchmarks();
  std::filesystem::remove_all(folder);
  return 0;
}

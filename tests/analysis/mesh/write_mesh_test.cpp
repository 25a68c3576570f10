#include "timbre/analysis/mesh/write_mesh.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/read_mesh.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/refused_request.h"
#include "timbre/tests/support/temporary_folder.h"

namespace timbre {
namespace {

// Doubles of every size, with vertices and faces that nothing may tidy up.
TriangleMesh awkward_mesh() {
  TriangleMesh mesh = grid(5);
  std::mt19937_64 random(1);
  for (double& c : mesh.vertices.reshaped()) {
    do {
      const std::uint64_t bits = random();
      std::memcpy(&c, &bits, sizeof c);
    } while (!std::isfinite(c));
  }
  mesh.vertices.row(3) << 0.0, -0.0, std::numeric_limits<double>::denorm_min();
  mesh.vertices.row(4) = mesh.vertices.row(3);
  mesh.faces.row(7) = mesh.faces.row(6);
  mesh.faces.row(8) << 1, 1, 2;
  return mesh;
}

class EveryFormat : public testing::TestWithParam<MeshFormat> {};

TEST_P(EveryFormat, ReadsBackBitForBit) {
  const TriangleMesh mesh = awkward_mesh();
  const std::string bytes = to_mesh_bytes(mesh, GetParam());
  const TriangleMesh back = read_mesh_bytes(bytes, "m").mesh;
  ASSERT_EQ(back.vertices.rows(), mesh.vertices.rows());
  EXPECT_EQ(std::memcmp(back.vertices.data(), mesh.vertices.data(),
                        sizeof(double) * static_cast<std::size_t>(mesh.vertices.size())),
            0);
  EXPECT_EQ(back.faces, mesh.faces);
  EXPECT_EQ(to_mesh_bytes(back, GetParam()), bytes);
}
INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat,
                         testing::Values(MeshFormat::off, MeshFormat::obj, MeshFormat::ply,
                                         MeshFormat::freesurfer_text, MeshFormat::vtk));

TEST(ToMeshBytes, WritesShortNumbers) {
  EXPECT_EQ(to_mesh_bytes(make_mesh({{0, 0.1, 1e300}}, {{0, 0, 0}}), MeshFormat::off),
            "OFF\n1 1 0\n0 0.1 1e+300\n3 0 0 0\n");
  EXPECT_EQ(to_mesh_bytes(make_mesh({{0, 0.1, -0.0}}, {{0, 0, 0}}), MeshFormat::obj),
            "v 0 0.1 -0\nf 1 1 1\n");
}

TEST(WriteMesh, ChoosesTheFormatByTheEnding) {
  const TemporaryFolder folder;
  for (const std::string name : {"a.off", "a.OBJ", "a.ply", "a.asc", "a.vtk", "a.glb", "lh.white",
                                 "rh.PIAL", "inner.surf"}) {
    write_mesh(tetrahedron(), folder / name);
    EXPECT_EQ(read_mesh(folder / name).mesh.faces, tetrahedron().faces);
  }
  write_mesh(tetrahedron(), folder / "a.stl");
  EXPECT_EQ(read_mesh(folder / "a.stl").format, "stl");
  EXPECT_EQ(
      refused_request([&] { write_mesh(tetrahedron(), folder / "a.dae"); }),
      folder / "a.dae" +
          ": output: the ending tells the format; .off, .obj, .ply, .vtk, .glb, .stl, .asc "
          "and FreeSurfer's .white, .pial, .inflated, .sphere, .orig, .smoothwm, .surf can be "
          "written");
}

TEST(WriteMesh, ReplacesOnlyWhenToldTo) {
  const TemporaryFolder folder;
  write_mesh(tetrahedron(), folder / "a.off");
  EXPECT_THROW(write_mesh(grid(1), folder / "a.off"), Error);
  write_mesh(grid(1), folder / "a.off", true);
  EXPECT_EQ(read_mesh(folder / "a.off").mesh.faces.rows(), 2);
}

}  // namespace
}  // namespace timbre

#include <gtest/gtest.h>

#include <cstring>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/detail/writers.h"
#include "timbre/analysis/mesh/read_mesh.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/refused_request.h"

namespace timbre::detail {
namespace {

TEST(GlbBytes, ReadsBackAsFloats) {
  TriangleMesh mesh = torus(7, 5);
  mesh.faces.row(3) << 2, 2, 1;
  mesh.vertices.row(0) << -0.0, 1e-45, 3e38;
  const TriangleMesh back = read_mesh_bytes(glb_bytes(mesh), "m.glb").mesh;
  const Points rounded = mesh.vertices.cast<float>().cast<double>();
  EXPECT_EQ(std::memcmp(back.vertices.data(), rounded.data(),
                        sizeof(double) * static_cast<std::size_t>(rounded.size())),
            0);
  EXPECT_EQ(back.faces, mesh.faces);
  EXPECT_EQ(glb_bytes(back), glb_bytes(mesh));
}

TEST(GlbBytes, TellsTheExactBoxAndItsOwnLength) {
  const TriangleMesh mesh = make_mesh({{0.1, -2, 0}, {1, 0, 0}, {0, 1, 0.5}}, {{0, 1, 2}});
  const std::string bytes = glb_bytes(mesh);
  EXPECT_NE(bytes.find(R"("min":[0,-2,0],"max":[1,1,0.5])"), std::string::npos);
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 8, sizeof length);
  EXPECT_EQ(length, bytes.size());
  EXPECT_EQ(bytes.size() % 4, 0U);
  const TriangleMesh moved = make_mesh({{0.1, 1, 0}, {1, 1, 0}, {1, 1, 1}}, {{0, 1, 2}});
  EXPECT_NE(glb_bytes(moved).find(R"("min":[0.10000000149011612,1,0])"), std::string::npos);
}

TEST(GlbBytes, RefusesWhatTheFormatCannotHold) {
  EXPECT_EQ(refused_request([] {
              (void)glb_bytes(make_mesh({{0, 0, 0}}, {}));
            }),
            "output: a mesh without faces is nothing that .glb holds; .ply keeps it");
  EXPECT_EQ(refused_request([] { (void)glb_bytes({}); }),
            "output: a mesh without faces is nothing that .glb holds; .ply keeps it");
  EXPECT_EQ(refused_request([] {
              (void)glb_bytes(make_mesh({{1e39, 0, 0}}, {{0, 0, 0}}));
            }),
            "output: a coordinate is beyond the range of a float; .ply keeps it");
  EXPECT_EQ(glb_body_size(200000000, 150000000), 4200000000U);
  EXPECT_EQ(refused_request([] { (void)glb_body_size(200000000, 160000000); }),
            "output: more than the 4 GiB of a .glb; use .ply");
}

}  // namespace
}  // namespace timbre::detail

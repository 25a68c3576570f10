#include <gtest/gtest.h>

#include <limits>

#include "timbre/analysis/mesh/write_mesh.h"
#include "timbre/tests/support/byte_order.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/read_text.h"
#include "timbre/tests/support/refused_request.h"

namespace timbre {
namespace {

const std::string kTriangleMagic = "\xff\xff\xfe";
const std::string kOldQuadMagic = "\xff\xff\xff";
const std::string kNewQuadMagic = "\xff\xff\xfd";
const std::string kStamp = "created by someone on a day\n\n";

MeshFile read(const std::string& bytes) { return read_mesh_bytes(bytes, "lh.white"); }

std::string triangles(std::initializer_list<std::int32_t> counts,
                      std::initializer_list<float> coordinates,
                      std::initializer_list<std::int32_t> corners) {
  return kTriangleMagic + kStamp + big_endian(counts) + big_endian(coordinates) +
         big_endian(corners);
}

std::string three_bytes(std::initializer_list<std::int32_t> values) {
  std::string bytes;
  for (const std::int32_t value : values) bytes += big_endian({value}).substr(1);
  return bytes;
}

std::string one_triangle() { return triangles({3, 1}, {0, 0, 0, 1, 0, 0, 0, 1.5F, 0}, {2, 0, 1}); }

std::string new_quad() {
  return kNewQuadMagic + three_bytes({4, 1}) +
         big_endian<float>({0, 0, 0, 1, 0, 0, 1, 2.5F, 0, 0, 1, 0}) + three_bytes({0, 1, 2, 3});
}

const std::string kText =
    "#!ascii version of lh.pial\n3 1\n0 0 0 0\n1 0 0 0\n0 0.1 1e-3 0\n2 0 1 0\n";

TEST(ReadFreesurfer, ReadsTriangles) {
  const MeshFile file = read(one_triangle());
  EXPECT_EQ(file.format, "freesurfer");
  EXPECT_EQ(summary(file), "3/1");
  EXPECT_EQ(file.mesh.vertices.row(2), Eigen::RowVector3d(0, 1.5, 0));
  EXPECT_EQ(file.mesh.faces.row(0), Eigen::RowVector3i(2, 0, 1));
}

TEST(ReadFreesurfer, SplitsQuads) {
  const MeshFile quad = read(new_quad());
  EXPECT_EQ(summary(quad), "4/2 triangulated=1");
  EXPECT_EQ(quad.mesh.vertices(2, 1), 2.5);

  const MeshFile old =
      read(kOldQuadMagic + three_bytes({4, 1}) +
           big_endian<std::int16_t>({0, 0, 0, 100, 0, 0, 100, 12345, 0, -7, 5, 0}) +
           three_bytes({0, 1, 2, 3}));
  EXPECT_EQ(summary(old), "4/2 triangulated=1");
  EXPECT_EQ(old.mesh.vertices.row(2), Eigen::RowVector3d(1, 123.45, 0));
  EXPECT_EQ(old.mesh.vertices.row(3), Eigen::RowVector3d(-0.07, 0.05, 0));
}

TEST(ReadFreesurfer, ReadsText) {
  const MeshFile file = read(kText);
  EXPECT_EQ(file.format, "freesurfer");
  EXPECT_EQ(summary(file), "3/1");
  EXPECT_EQ(file.mesh.vertices.row(2), Eigen::RowVector3d(0, 0.1, 0.001));
  EXPECT_EQ(file.mesh.faces.row(0), Eigen::RowVector3i(2, 0, 1));
  EXPECT_EQ(summary(read("#!ascii\r\n1 0\r\n1 2 3\r\n")), "1/0 no-faces=1");
}

TEST(ReadFreesurfer, IsKnownByContentAndTextByItsEndingToo) {
  EXPECT_EQ(summary(read_mesh_bytes(one_triangle(), "m.off")), "3/1");
  EXPECT_EQ(summary(read_mesh_bytes(new_quad(), "m.stl")), "4/2 triangulated=1");
  EXPECT_EQ(summary(read_mesh_bytes(kText, "m.ply")), "3/1");
  EXPECT_EQ(summary(read_mesh_bytes(kText.substr(kText.find('\n') + 1), "m.ASC")), "3/1");
}

TEST(ReadFreesurfer, AllowsTagsAfterTheSurface) {
  EXPECT_EQ(codes(read(one_triangle() + big_endian({2, 0, 20}) + "valid = 1  # volume info\n")),
            "");
  EXPECT_EQ(codes(read(one_triangle() + big_endian({20}) + "valid = 1\n")), "");
  EXPECT_EQ(codes(read(one_triangle() + big_endian({3, 0, 9}) + "mris_xyz\n")), "");
  EXPECT_EQ(codes(read(one_triangle() + "\n")), "");
  EXPECT_EQ(codes(read(one_triangle() + big_endian({0}))), "trailing-data=1");
  EXPECT_EQ(codes(read(one_triangle() + "abcd")), "trailing-data=1");
  EXPECT_EQ(codes(read(kText + "0 1 2 0\n")), "trailing-data=1");
}

TEST(ReadFreesurfer, RefusesBinaryWithByteAndElement) {
  const float inf = std::numeric_limits<float>::infinity();
  const std::string magic_only = kTriangleMagic + "one line\n";
  expect_refused(
      {
          {kTriangleMagic, "byte 0: truncated: two lines of text are needed"},
          {magic_only, "byte 3: truncated: two lines of text are needed"},
          {kTriangleMagic + kStamp + big_endian({0}),
           "byte 36: truncated: 4 bytes are needed, 0 are left"},
          {triangles({-1, 1}, {}, {}), "byte 32: -1 vertices are declared; at least 0 is needed"},
          {triangles({9, 1}, {0, 0, 0}, {}),
           "byte 32: 9 vertices are declared, more than the file can hold"},
          {triangles({1, 9}, {0, 0, 0}, {}),
           "byte 36: 9 faces are declared, more than the file can hold"},
          {triangles({1, 1}, {0, 0, 0}, {}),
           "byte 52, face 0: truncated: 4 bytes are needed, 0 are left"},
          {triangles({1, 1}, {0, inf, 0}, {0, 0, 0}),
           "byte 44, vertex 0: coordinate is not finite"},
          {triangles({1, 1}, {0, 0, 0}, {0, 1, 0}),
           "byte 56, face 0: index 1 is out of range; the file has 1 vertices"},
          {triangles({1, 1}, {0, 0, 0}, {0, 0, -1}),
           "byte 60, face 0: index -1 is out of range; the file has 1 vertices"},
          {triangles({1, 0}, {0, 0, 0}, {}) + "abcd",
           "header: no faces are declared, but more data follow"},
          {kOldQuadMagic + "ab", "byte 3: truncated: 3 bytes are needed, 2 are left"},
          {kOldQuadMagic + big_endian<std::int32_t>({2, 4, 1}) + big_endian<float>({0.5F, 0.25F}),
           "byte 0: values of vertices (curvature, thickness), not a surface"},
          {kOldQuadMagic + three_bytes({9, 1}),
           "byte 3: 9 vertices are declared, more than the file can hold"},
          {kNewQuadMagic + three_bytes({1, 1}) + big_endian<float>({0, 0, 0}) +
               three_bytes({0, 0, 0, 1}),
           "byte 30, face 0: index 1 is out of range; the file has 1 vertices"},
      },
      "lh.white");
}

TEST(ReadFreesurfer, RefusesTextWithLineAndElement) {
  const std::string head = "#!ascii\n";
  expect_refused(
      {
          {head, "end of file: truncated"},
          {head + "0\n", "line 2: an integer is missing"},
          {head + "1 0 0\n0 0 0\n", "line 2: '0' is one count too many"},
          {head + "9 1\n0 0 0 0\n", "line 2: 9 vertices are declared, more than the file can hold"},
          {head + "1 9\n0 0 0 0\n", "line 2: 9 faces are declared, more than the file can hold"},
          {head + "2 0\n0 0 0 0 \n \n\n", "end of file: truncated: vertex 1 is missing"},
          {head + "1 1\n0 0 0 0 \n \n\n", "end of file: truncated: face 0 is missing"},
          {head + "1 1\n0 0\n0 0 0 0\n", "line 3, vertex 0: too few numbers"},
          {head + "1 1\n0 0 0 0 7\n0 0 0 0\n", "line 3, vertex 0: '7' is one value too many"},
          {head + "1 1\n0 0 nan 0\n0 0 0 0\n",
           "line 3, vertex 0: 'nan' is not a decimal number in the range of a double"},
          {head + "1 1\n0 0 0 0\n0 0 1 0\n",
           "line 4, face 0: index 1 is out of range; the file has 1 vertices"},
          {head + "1 1\n0 0 0 0\n0 0 0 0 0\n", "line 4, face 0: '0' is one value too many"},
          {head + "1 1\n0 0 0 0\n0 0\n\n\n", "line 4, face 0: an integer is missing"},
          {head + std::string(1, '\0'), "byte 8: NUL byte in text"},
      },
      "lh.asc");
}

TEST(ReadFreesurfer, SeesEveryCut) {
  expect_cuts_are_seen(one_triangle() + big_endian({2, 0, 20}) + "valid = 1\n", "lh.white");
  expect_cuts_are_seen(new_quad(), "lh.orig");
  expect_cuts_are_seen(kText, "lh.pial");
}

TEST(ReadFreesurfer, ReadsBackWhatIsWrittenInFloats) {
  TriangleMesh mesh = grid(4);  // multiples of 1/4
  const std::string bytes = to_mesh_bytes(mesh, MeshFormat::freesurfer);
  const MeshFile back = read(bytes);
  EXPECT_EQ(back.mesh.vertices, mesh.vertices);
  EXPECT_EQ(back.mesh.faces, mesh.faces);
  mesh.vertices(1, 1) = 0.1;
  EXPECT_EQ(read(to_mesh_bytes(mesh, MeshFormat::freesurfer)).mesh.vertices(1, 1), double{0.1F});
}

TEST(ReadFreesurfer, RefusesToWriteWhatNoFloatHolds) {
  const TriangleMesh mesh = make_mesh({{0, 0, 1e39}}, {});
  EXPECT_EQ(refused_request([&] { (void)to_mesh_bytes(mesh, MeshFormat::freesurfer); }),
            "output: a coordinate is beyond the range of a float; .ply keeps it");
}

}  // namespace
}  // namespace timbre

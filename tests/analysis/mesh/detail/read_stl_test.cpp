#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "timbre/tests/support/read_text.h"

namespace timbre {
namespace {

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
  return "facet normal 0 nan 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
         "\nendloop\nendfacet\n";
}

template <typename T>
std::string little(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

std::string binary(std::uint32_t count, const std::vector<std::array<float, 9>>& facets,
                   std::string header = "solid not text") {
  header.resize(80, '\0');
  std::string bytes = header + little(count);
  for (const auto& corners : facets) {
    bytes += little(std::nanf("")) + little(0.0F) + little(0.0F);
    for (const float x : corners) bytes += little(x);
    bytes += "ab";
  }
  return bytes;
}

const std::array<float, 9> kOne = {0, 0, 0, 1, 0, 0, 0, 1, 0};
const std::array<float, 9> kTwo = {-0.0F, 0, 0, 0, 1, 0, 0, 0, 1};

MeshFile read(const std::string& bytes, const ReadOptions& options = {}) {
  return read_mesh_bytes(bytes, "m.stl", options);
}

TEST(ReadStl, JoinsEqualCornersInOrderOfAppearance) {
  const std::string text = "solid a b\n" + facet("0 0 0", "1 0 0", "0 1 0") +
                           facet("-0 0 0", "0 1 0", "0 0 1") + "endsolid a b\n";
  for (const MeshFile& file : {read(text), read(binary(2, {kOne, kTwo}))}) {
    EXPECT_EQ(file.format, "stl");
    EXPECT_EQ(summary(file), "4/2 welded=2");
    EXPECT_EQ(file.mesh.vertices.row(3), Eigen::RowVector3d(0, 0, 1));
    EXPECT_EQ(file.mesh.faces.row(1), Eigen::RowVector3i(0, 2, 3));
  }
}

TEST(ReadStl, GivesTheSameVerticesWhicheverZeroComesFirst) {
  const Points vertices = read(binary(2, {kTwo, kOne})).mesh.vertices;
  EXPECT_FALSE(std::signbit(vertices(0, 0)));
}

TEST(ReadStl, KeepsCornersApartOnRequest) {
  const MeshFile file = read(binary(2, {kOne, kTwo}), {.soup = true});
  EXPECT_EQ(summary(file), "6/2 coincident-vertex=2");
  EXPECT_TRUE(std::signbit(file.mesh.vertices(3, 0)));
}

TEST(ReadStl, JoinsSolidsAndTakesAnyCase) {
  const std::string solid = "SOLID\n" + facet("0 0 0", "1 0 0", "0 1 0") + "EndSolid\n";
  EXPECT_EQ(summary(read(solid + "\n" + solid)), "3/2 duplicate-face=1 welded=3");
  EXPECT_EQ(summary(read("solid\nendsolid")), "0/0 no-faces=1");
}

TEST(ReadStl, TakesBinaryBySizeWhateverTheHeaderOrTheName) {
  for (const char* head : {"OFF", "ply", "solid", "\xff\xfe", "v 1 2 3"}) {
    EXPECT_EQ(summary(read_mesh_bytes(binary(1, {kOne}, head), "m.off")), "3/1") << head;
  }
  EXPECT_EQ(summary(read(binary(0, {}))), "0/0 no-faces=1");
  EXPECT_EQ(summary(read(binary(1, {kOne}) + std::string(49, 'x'))), "3/1 trailing-data=1");
}

TEST(ReadStl, RefusesBinaryWhoseSizeDisagrees) {
  std::array<float, 9> infinite = kOne;
  infinite[8] = std::numeric_limits<float>::infinity();
  expect_refused(
      {
          {binary(1, {kOne}).substr(0, 83),
           "end of file: truncated: a binary STL has at least 84 bytes"},
          {binary(2, {kOne}), "byte 80: 2 facets are declared, the file has room for 1"},
          {binary(1, {kOne, kTwo}), "byte 80: 1 facets are declared, the file has room for 2"},
          {binary(0, {kOne}), "byte 80: 0 facets are declared, the file has room for 1"},
          {binary(0xffffffffU, {kOne}),
           "byte 80: 4294967295 facets are declared, the file has room for 1"},
          {binary(1, {infinite}), "byte 128, facet 0: coordinate is not finite"},
      },
      "m.stl");
}

TEST(ReadStl, RefusesTextWithTheLine) {
  const std::string good = facet("0 0 0", "1 0 0", "0 1 0");
  const std::string needed = "unexpected words; ";
  expect_refused(
      {
          {"solid\n" + good, "end of file: truncated"},
          {"solid\n" + good + "endsolid\nx", "line 10: " + needed + "'solid' is needed"},
          {"solid\nhello\n", "line 2: " + needed + "'facet normal' or 'endsolid' is needed"},
          {"solid\nfacet 0 0 0\n", "line 2: " + needed + "'facet normal' or 'endsolid' is needed"},
          {"solid\nfacet normal 0 0\n", "line 2: a normal needs 3 numbers"},
          {"solid\nfacet normal 0 0 0\nloop\n", "line 3: " + needed + "'outer loop' is needed"},
          {"solid\n" + facet("0 0", "1 0 0", "0 1 0"), "line 4: too few numbers"},
          {"solid\n" + facet("0 0 0", "1 0 0 0", "0 1 0"), "line 5: '0' is one value too many"},
          {"solid\n" + facet("0 0 0", "1 0 x", "0 1 0"),
           "line 5: 'x' is not a decimal number in the range of a double"},
          {"solid\n" + facet("0 0 0", "1 0 0", "0 1 0\nvertex 0 0 0"),
           "line 7: " + needed + "'endloop' is needed"},
          {"solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nendloop\n",
           "line 5: " + needed + "'vertex' is needed"},
          {"solid\n" + good.substr(0, good.size() - 9) + "endsolid\n",
           "line 8: " + needed + "'endfacet' is needed"},
      },
      "m.stl");
}

}  // namespace
}  // namespace timbre

#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "timbre/tests/support/read_text.h"

namespace timbre {
namespace {

MeshFile read(const std::string& text) { return read_mesh_bytes(text, "m.off"); }

const std::string kBody = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

template <typename T>
std::string in_order(T value, std::endian order) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return order == std::endian::native ? bytes : std::string(bytes.rbegin(), bytes.rend());
}

std::string binary(std::initializer_list<std::int32_t> counts,
                   std::initializer_list<float> coordinates,
                   std::initializer_list<std::int32_t> faces,
                   std::endian order = std::endian::big) {
  std::string bytes = "OFF BINARY\n";
  for (const std::int32_t i : counts) bytes += in_order(i, order);
  for (const float x : coordinates) bytes += in_order(x, order);
  for (const std::int32_t i : faces) bytes += in_order(i, order);
  return bytes;
}

TEST(ReadOff, KeepsVerticesAndFacesInTheirOrder) {
  const MeshFile file = read("OFF\n4 4 6\n" + kBody);
  EXPECT_EQ(file.format, "off");
  EXPECT_EQ(summary(file), "4/4");
  EXPECT_EQ(file.mesh.vertices.row(3), Eigen::RowVector3d(0, 0, 1));
  EXPECT_EQ(file.mesh.faces.row(0), Eigen::RowVector3i(0, 2, 1));
  EXPECT_EQ(file.mesh.faces.row(3), Eigen::RowVector3i(2, 0, 3));
}

TEST(ReadOff, TakesEveryHeader) {
  EXPECT_EQ(summary(read("off\n4 4\n" + kBody)), "4/4");
  EXPECT_EQ(summary(read("OFF 4 4 0\n" + kBody)), "4/4");
  EXPECT_EQ(summary(read("OFF4 4 0\n" + kBody)), "4/4 glued-header=1");
  EXPECT_EQ(summary(read("nOFF 3\n4 4 0\n" + kBody)), "4/4");
  EXPECT_EQ(summary(read("nOFF\n3 4 4 0\n" + kBody)), "4/4");
}

TEST(ReadOff, ReadsPositionsBesideOtherValues) {
  const std::string face = "3 0 1 2 255 0 0\n";
  const auto third = [&](const std::string& keyword, const std::string& tail) {
    const std::string text =
        keyword + " 3 1 0\n0 0 0 " + tail + "\n1 0 0 " + tail + "\n0 1 8 " + tail + "\n" + face;
    const MeshFile file = read(text);
    EXPECT_EQ(codes(file), "") << keyword;
    return file.mesh.vertices(2, 2);
  };
  EXPECT_EQ(third("NOFF", "nan 0 1"), 8.0);
  EXPECT_EQ(third("COFF", "1 2 3"), 8.0);
  EXPECT_EQ(third("COFF", "1 2 3 4"), 8.0);
  EXPECT_EQ(third("STOFF", "0.5 0.5"), 8.0);
  EXPECT_EQ(third("STCNOFF", "0 0 1 1 2 3 0.5 0.5"), 8.0);
  EXPECT_EQ(third("4OFF", "2"), 4.0);
}

TEST(ReadOff, CountsValuesNobodyDeclared) {
  EXPECT_EQ(summary(read("OFF 3 1 0\n0 0 0 9\n1 0 0\n0 1 0 9 9 9\n3 0 1 2\n")),
            "3/1 extra-values=2");
}

TEST(ReadOff, SkipsCommentsAndBlankLines) {
  EXPECT_EQ(
      summary(read("# a\n\nOFF # b\n# c\n3 1 0\n0 0 0# d\n\n1 0 0\n  \n0 1 0\n3 0 1 2 #\n#e")),
      "3/1");
}

TEST(ReadOff, SaysWhatFollowsTheMesh) {
  EXPECT_EQ(summary(read("OFF 4 4 0\n" + kBody + "3 0 1 2\n")), "4/4 trailing-data=1");
}

TEST(ReadOff, LeavesOutPointsAndLines) {
  EXPECT_EQ(summary(read("OFF 3 4 0\n0 0 0\n1 0 0\n0 1 0\n0\n1 0\n2 0 1\n3 0 1 2\n")),
            "3/1 dropped-element=3");
}

TEST(ReadOff, RefusesWithLineAndElement) {
  const std::string three = "0 0 0\n1 0 0\n0 1 0\n";
  expect_refused(
      {
          {"OFF\n", "end of file: truncated"},
          {"nOFF", "end of file: truncated"},
          {"OFF\n4\n", "line 2: an integer is missing"},
          {"OFF\n4.0 4 0\n", "line 2: '4.0' is not an integer of 64 bits"},
          {"OFF 3 1 x\n" + three, "line 1: 'x' is not an integer of 64 bits"},
          {"OFF99999999999999999999 1 0\n",
           "line 1: '99999999999999999999' is not an integer of 64 bits"},
          {"OFF\n-1 1 0\n", "line 2: -1 vertices are declared; at least 0 is needed"},
          {"OFF\n3 -1 0\n" + three, "line 2: -1 faces are declared; at least 0 is needed"},
          {"OFF\n9 1 0\n" + three, "line 2: 9 vertices are declared, more than the file can hold"},
          {"OFF\n3 99 0\n" + three, "line 2: 99 faces are declared, more than the file can hold"},
          {"OFF\n3 9 0\n" + three,
           "line 2: vertices and faces are declared, more than the file can hold"},
          {"nOFF 5\n3 1 0\n", "line 1: 5 dimensions; only 3 are read"},
          {"OFF 3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "line 3, vertex 1: too few numbers"},
          {"OFF 3 1 0\n0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n",
           "line 3, vertex 1: 'x' is not a decimal number in the range of a double"},
          {"OFF 3 1 0\r0 0 0\r1 0 1e999\r0 1 0\r3 0 1 2\r",
           "line 3, vertex 1: '1e999' is not a decimal number in the range of a double"},
          {"4OFF 3 1 0\n0 0 0 1\n1 0 0 0\n0 1 0 1\n3 0 1 2\n",
           "line 3, vertex 1: w is 0: a point at infinity"},
          {"4OFF 3 1 0\n0 0 0 1\n1e300 0 0 1e-300\n0 1 0 1\n3 0 1 2\n",
           "line 3, vertex 1: x y z over w are beyond the range of a double"},
          {"NOFF 3 1 0\n0 0 0 1 1 1\n1 0 0 1 1\n0 1 0 1 1 1\n3 0 1 2\n",
           "line 3, vertex 1: 5 values; the header asks for 6"},
          {"COFF 3 1 0\n0 0 0 1 1\n1 0 0 1 1\n0 1 0 1 1 1\n3 0 1 2\n",
           "line 2, vertex 0: 5 values; the header asks for 6 or one more"},
          {"COFF 3 1 0\n0 0 0 1 1 1 1 1\n1 0 0 1 1\n0 1 0 1 1 1\n3 0 1 2\n",
           "line 2, vertex 0: 8 values; the header asks for 6 or one more"},
          {"OFF 3 2 0\n" + three + "3 0 1 2\n", "end of file: truncated: face 1 is missing"},
          {"OFF 3 1 0\n0 0 0 7 7 7 7\n1 0 0\n", "end of file: truncated: vertex 2 is missing"},
          {"OFF 3 1 0\n" + three + "3 0 1\n", "line 5, face 0: an integer is missing"},
          {"OFF 3 1 0\n" + three + "3 0 1 3\n",
           "line 5, face 0: index 3 is out of range; the file has 3 vertices"},
          {"OFF 3 1 0\n" + three + "3 0 1 -1\n",
           "line 5, face 0: index -1 is out of range; the file has 3 vertices"},
          {"OFF 3 1 0\n" + three + "-3 0 1 2\n", "line 5, face 0: -3 corners"},
          {"OFF 3 0 0\n" + three + "3 0 1 2\n",
           "header: no faces are declared, but more data follow"},
          {std::string("OFF 3 1 0\n") + '\0' + three, "byte 10: NUL byte in text"},
          {"COFF BINARY\n1 0 0\n", "line 1: 'BINARY' is not an integer of 64 bits"},
      },
      "m.off");
}

TEST(ReadOff, ReadsBinaryInBothByteOrders) {
  const MeshFile big =
      read(binary({3, 2, 0}, {0, 0, 0, 1, 0, 0, 0, 1.5F, 0}, {3, 0, 1, 2, 0, 3, 2, 1, 0, 1, 77}));
  EXPECT_EQ(summary(big), "3/2 duplicate-face=1");
  EXPECT_EQ(big.mesh.vertices(2, 1), 1.5);
  EXPECT_EQ(big.mesh.faces.row(1), Eigen::RowVector3i(2, 1, 0));
  const MeshFile little =
      read(binary({3, 1, 0}, {0, 0, 0, 1, 0, 0, 0, 1.5F, 0}, {3, 0, 1, 2}, std::endian::little));
  EXPECT_EQ(summary(little), "3/1");
  EXPECT_EQ(little.mesh.vertices(2, 1), 1.5);
}

TEST(ReadOff, AllowsWhiteSpaceAfterBinary) {
  const std::string bytes = binary({3, 1, 0}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, {3, 0, 1, 2, 0});
  EXPECT_EQ(codes(read(bytes + " \n")), "");
  EXPECT_EQ(codes(read(bytes + "x")), "trailing-data=1");
}

TEST(ReadOff, RefusesBinaryWithByteAndElement) {
  const float inf = std::numeric_limits<float>::infinity();
  expect_refused(
      {
          {binary({1, 0}, {}, {}), "byte 19: truncated: 4 bytes are needed, 0 are left"},
          {binary({9, 1, 0}, {0, 0, 0}, {}),
           "byte 19: 9 vertices are declared, more than the file can hold"},
          {binary({-1, 1, 0}, {0, 0, 0}, {}),
           "byte 19: -1 vertices are declared; at least 0 is needed"},
          {binary({1, 1, 0}, {0, inf, 0}, {1, 0, 0}),
           "byte 27, vertex 0: coordinate is not finite"},
          {binary({1, 1, 0}, {0, 0, 0}, {1, 1, 0}),
           "byte 39, face 0: index 1 is out of range; the file has 1 vertices"},
          {binary({1, 1, 0}, {0, 0, 0}, {9, 0, 0}),
           "byte 35, face 0: 9 corners are declared, more than the file can hold"},
          {binary({1, 1, 0}, {0, 0, 0}, {1, 0, 99}),
           "byte 43, face 0: 99 colours are declared, more than the file can hold"},
          {binary({1, 1, 0}, {0, 0, 0}, {1, 0}),
           "byte 43, face 0: truncated: 4 bytes are needed, 0 are left"},
      },
      "m.off");
}

}  // namespace
}  // namespace timbre

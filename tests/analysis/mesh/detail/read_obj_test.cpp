#include <gtest/gtest.h>

#include "timbre/tests/support/read_text.h"

namespace timbre {
namespace {

const std::string kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

MeshFile read(const std::string& text) { return read_mesh_bytes(text, "m.obj"); }

TEST(ReadObj, TakesEveryFormOfCorner) {
  for (const char* face : {"f 1 2 3", "f 1/1 2/9 3/", "f 1//1 2//9 3//", "f 1/1/1 2/-2/+3 3/9/9",
                           "f -3 -2 -1", "f 1 -2 3", "f 1/99999999999999999999 2 3"}) {
    const MeshFile file = read(kThree + face + "\n");
    EXPECT_EQ(file.format, "obj");
    EXPECT_EQ(summary(file), "3/1") << face;
    EXPECT_EQ(file.mesh.faces.row(0), Eigen::RowVector3i(0, 1, 2)) << face;
  }
}

TEST(ReadObj, LetsPositiveIndicesPointForward) {
  EXPECT_EQ(read("f 1 2 3\n" + kThree).mesh.faces.row(0), Eigen::RowVector3i(0, 1, 2));
}

TEST(ReadObj, CountsNegativeIndicesFromTheirLine) {
  const MeshFile file = read(kThree + "f -3 -2 -1\nv 5 0 0\nf -1 -2 -3\n");
  EXPECT_EQ(file.mesh.faces.row(1), Eigen::RowVector3i(3, 2, 1));
}

TEST(ReadObj, TakesWeightsAndColours) {
  const MeshFile file = read("v 0 0 0 2\nv 1 0 0 1 0 0\nv 0 1 7 nan inf -NaN(ind) 1\nf 1 2 3\n");
  EXPECT_EQ(summary(file), "3/1");
  EXPECT_EQ(file.mesh.vertices(2, 2), 7.0);
}

TEST(ReadObj, JoinsContinuedLines) {
  EXPECT_EQ(summary(read("v 0 \\\n0 0\nv 1 0 0\nv 0 1 0\nf 1 \\ \t\r\n 2\\\n 3")), "3/1");
  EXPECT_EQ(summary(read(kThree + "f 1 2 3\\")), "3/1");
  EXPECT_EQ(summary(read(kThree + "# no \\\nf 1 2 3\n")), "3/1");
  EXPECT_EQ(summary(read(kThree + "vn 0 0 \\\n 1\nf 1 2 3\n")), "3/1");
  EXPECT_EQ(summary(read("mtllib C:\\a\\b.mtl\n" + kThree + "f 1 2 3\n")), "3/1");
}

TEST(ReadObj, CountsWhatItDoesNotRead) {
  const MeshFile file = read("mtllib a.mtl\no a\ng b\ns 1\nusemtl c\nvt 0 0\nvn 0 0 nan\n" +
                             kThree + "l 1 2\np 1\nf 1 2\ncurv 0 1\nhello\nf 1 2 3 # f 1\n");
  EXPECT_EQ(summary(file), "3/1 dropped-element=3 ignored-data=2");
  EXPECT_EQ(file.warnings[1].message, "kinds of data not read: 2 (curv, hello)");
}

TEST(ReadObj, RefusesWithTheLine) {
  expect_refused(
      {
          {"o empty\n", "end of file: no vertices ('v' lines)"},
          {"v 0 0\n", "line 1: too few numbers"},
          {"v 0 0 0,5\n", "line 1: '0,5' is not a decimal number in the range of a double"},
          {"v 0 0 0 1 1\n",
           "line 1: a vertex of 5 values; 3, 4 (w), 6 (r g b) or 7 (r g b a) are known"},
          {"v 0 0 0 1 1 1 1 1\n",
           "line 1: a vertex of 8 values; 3, 4 (w), 6 (r g b) or 7 (r g b a) are known"},
          {"v 0 0 0 w\n", "line 1: 'w' is not a number"},
          {kThree + "f\n", "line 4: a face without corners"},
          {kThree + "f 1 2 0\n", "line 4: index 0; OBJ counts from 1"},
          {kThree + "\nf 1 2 4\n", "line 5: index 4 is out of range; there are 3 vertices"},
          {kThree + "f 1 2 -4\n", "line 4: index -4 is out of range; there are 3 vertices"},
          {kThree + "f 1 2 4294967297\n",
           "line 4: index 4294967297 is out of range; there are 3 vertices"},
          {kThree + "f 1 2 3/a\n",
           "line 4: '3/a' is not v, v/t, v//n or v/t/n in integers of 64 bits"},
          {kThree + "f 1 2 3/1/1/1\n",
           "line 4: '3/1/1/1' is not v, v/t, v//n or v/t/n in integers of 64 bits"},
          {kThree + "f 1 2 3/+\n",
           "line 4: '3/+' is not v, v/t, v//n or v/t/n in integers of 64 bits"},
          {kThree + "f 1 2 /3\n",
           "line 4: '/3' is not v, v/t, v//n or v/t/n in integers of 64 bits"},
          {kThree + "f 1 2 18446744073709551617\n",
           "line 4: '18446744073709551617' is not v, v/t, v//n or v/t/n in integers of 64 bits"},
          {kThree + std::string("f 1 \0 2", 7), "byte 28: NUL byte in text"},
      },
      "m.obj");
}

}  // namespace
}  // namespace timbre

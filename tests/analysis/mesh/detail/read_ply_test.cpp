#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "timbre/tests/support/read_text.h"

namespace timbre {
namespace {

const std::string kFace = "property list uchar int vertex_indices\n";
const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

std::string header(const std::string& format, const std::string& rest) {
  return "ply\nformat " + format + " 1.0\n" + rest + "end_header\n";
}

// Three vertices and one face.
std::string usual_header(const std::string& format) {
  return header(format, "element vertex 3\n" + kXyz + "element face 1\n" + kFace);
}
const std::string kBody = "0 0 0\n1 0 0\n0 1.5 0\n3 0 1 2\n";

MeshFile read(const std::string& bytes) { return read_mesh_bytes(bytes, "m.ply"); }

template <typename... T>
std::string pack(std::endian order, T... values) {
  std::string bytes;
  const auto add = [&](auto value) {
    std::string one(sizeof value, '\0');
    std::memcpy(one.data(), &value, sizeof value);
    bytes += order == std::endian::native ? one : std::string(one.rbegin(), one.rend());
  };
  (add(values), ...);
  return bytes;
}

std::string binary_body(std::endian order) {
  return pack(order, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.5F, 0.0F) +
         pack(order, std::uint8_t{3}, 0, 1, 2);
}

TEST(ReadPly, ReadsAllThreeFormats) {
  for (const MeshFile& file :
       {read(usual_header("ascii") + kBody),
        read(usual_header("binary_little_endian") + binary_body(std::endian::little)),
        read(usual_header("binary_big_endian") + binary_body(std::endian::big))}) {
    EXPECT_EQ(file.format, "ply");
    EXPECT_EQ(summary(file), "3/1");
    EXPECT_EQ(file.mesh.vertices.row(2), Eigen::RowVector3d(0, 1.5, 0));
    EXPECT_EQ(file.mesh.faces.row(0), Eigen::RowVector3i(0, 1, 2));
  }
}

TEST(ReadPly, ReadsEveryTypeAndSkipsTheRest) {
  const std::string rest =
      "comment element vertex 9\nobj_info x\nelement camera 1\nproperty list uint16 int8 tag\n"
      "property double fov\nelement face 1\nproperty uint8 flag\n"
      "property list int32 uint16 vertex_index\nproperty list uchar float uv\n"
      "element vertex 3\nproperty uint32 z\nproperty list char short extra\nproperty int16 y\n"
      "property int8 x\nproperty float quality\n";
  const auto little = std::endian::little;
  const auto vertex = [&](unsigned z, short y, signed char x) {
    return pack(little, z, std::int8_t{1}, short{5}, y, x, std::nanf(""));
  };
  const std::string body = pack(little, std::uint16_t{2}, std::int8_t{1}, std::int8_t{2}, 1.0) +
                           pack(little, std::uint8_t{7}, 3, std::uint16_t{2}, std::uint16_t{1},
                                std::uint16_t{0}, std::uint8_t{1}, 0.5F) +
                           vertex(4000000000U, -3, -128) + vertex(0, 1, 0) + vertex(0, 0, 1);
  const MeshFile file = read(header("binary_little_endian", rest) + body);
  EXPECT_EQ(summary(file), "3/1 ignored-data=1");
  EXPECT_EQ(file.mesh.vertices.row(0), Eigen::RowVector3d(-128, -3, 4e9));
  EXPECT_EQ(file.mesh.faces.row(0), Eigen::RowVector3i(2, 1, 0));

  const MeshFile text = read(header("ascii", rest) +
                             "2 1 2 1.0\n7 3 2 1 0 1 0.5\n4000000000 1 5 -3 -128 nan\n\n"
                             "0 1 5 1 0 x\n0 1 5 0 1 0\n");
  EXPECT_EQ(summary(text), "3/1 ignored-data=1");
  EXPECT_EQ(text.mesh.vertices, file.mesh.vertices);
}

TEST(ReadPly, TakesEveryLineEnd) {
  const std::string text = usual_header("ascii") + kBody;
  for (const std::string end : {"\r\n", "\r", "\n"}) {
    std::string other;
    for (const char c : text) other += c == '\n' ? end : std::string(1, c);
    EXPECT_EQ(summary(read(other)), "3/1");
  }
  std::string crlf_header;
  for (const char c : usual_header("binary_big_endian")) {
    crlf_header += c == '\n' ? "\r\n" : std::string(1, c);
  }
  EXPECT_EQ(summary(read(crlf_header + binary_body(std::endian::big))), "3/1");
}

TEST(ReadPly, SaysWhatFollowsTheMesh) {
  EXPECT_EQ(codes(read(usual_header("ascii") + kBody + "\n 1\n")), "trailing-data=1");
  const std::string bytes = usual_header("binary_big_endian") + binary_body(std::endian::big);
  EXPECT_EQ(codes(read(bytes + " \r\n\n")), "");
  EXPECT_EQ(codes(read(bytes + "a")), "trailing-data=1");
}

TEST(ReadPly, ReadsPointsAlone) {
  EXPECT_EQ(summary(read(header("ascii", "element vertex 1\n" + kXyz) + "0 0 0\n")),
            "1/0 no-faces=1");
}

TEST(ReadPly, RefusesHeaders) {
  const std::string known =
      "; format, element, property, comment, obj_info and end_header make a header";
  expect_refused(
      {
          {"ply\n", "header: does not end; 'end_header' is missing"},
          {"ply x\n", "line 1: 'x' is one word too many"},
          {"ply\nend_header x\n", "line 2: 'x' is one word too many"},
          {"ply\nelement vertex 0\n" + kXyz + "end_header\n", "header: no line 'format'"},
          {"ply\n\nformat ascii 1.0\n", "line 2: '' is not expected here" + known},
          {"ply\nproperty int x\n", "line 2: 'property' is not expected here" + known},
          {header("ascii", "format ascii 1.0\n"), "line 3: 'format' is not expected here" + known},
          {"ply\nformat ascii 2.0\n", "line 2: version '2.0'; only 1.0 is known"},
          {"ply\nformat utf8 1.0\n",
           "line 2: format 'utf8'; ascii, binary_little_endian and binary_big_endian are known"},
          {"ply\nformat ascii 1.0 x\n", "line 2: 'x' is one word too many"},
          {header("ascii", "element\n"), "line 3: a name is missing"},
          {header("ascii", "element vertex\n"), "line 3: an integer is missing"},
          {header("ascii", "element vertex -1\n"), "line 3: a count below 0"},
          {header("ascii", "element a 0\nelement a 0\n"), "line 4: element 'a' is declared twice"},
          {header("ascii", "element vertex 0\nproperty quux x\n"),
           "line 4: 'quux' is no type of PLY; char, uchar, short, ushort, int, uint, float and "
           "double are"},
          {header("ascii", "element vertex 0\nproperty float\n"), "line 4: a name is missing"},
          {header("ascii", "element vertex 0\nproperty int x\nproperty int x\n"),
           "line 5: property 'x' is declared twice"},
          {header("ascii", "element face 0\nproperty list float int vertex_index\n"),
           "line 4: a list length must be an integer"},
          {header("ascii", ""), "header: no element 'vertex'"},
          {header("ascii", "element vertex 0\nproperty float x\nproperty float y\n"),
           "header: vertices need x, y and z, each one number"},
          {header("ascii", "element vertex 0\nproperty list int int x\n"),
           "header: vertices need x, y and z, each one number"},
          {header("ascii", "element vertex 0\n" + kXyz + "element face 0\nproperty int a\n"),
           "header: faces need a list of integers named vertex_indices or vertex_index"},
          {header("ascii", "element vertex 0\n" + kXyz +
                               "element face 0\nproperty list int float vertex_index\n"),
           "header: faces need a list of integers named vertex_indices or vertex_index"},
          {header("ascii", "element vertex 0\n" + kXyz + "element tristrips 0\n"),
           "header: faces held as tristrips are not read; write them as faces"},
          {header("ascii", "element vertex 0\n" + kXyz + "element a 4000000000\n"),
           "header: rows of 'a' have no properties"},
          {header("ascii", "element vertex 9\n" + kXyz) + "0 0 0\n",
           "line 7: 9 rows of 'vertex' are declared, more than the file can hold"},
      },
      "m.ply");
}

TEST(ReadPly, RefusesTextWithLineAndElement) {
  const std::string head = usual_header("ascii");
  const std::string three = "0 0 0\n1 0 0\n0 1 0\n";
  expect_refused(
      {
          {head + "0 0 0\n1 0 0 0 0 0 0 0\n",
           "line 11, vertex 1: '0' is one value more than the "
           "header declares"},
          {head + "0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "line 11, vertex 1: too few numbers"},
          {head + "0 0 0\n1 0 a\n0 1 0\n3 0 1 2\n",
           "line 11, vertex 1: 'a' is not a decimal number in the range of a double"},
          {head + three, "end of file: truncated: face 0 is missing"},
          {head + three + "3 0 1\n", "line 13, face 0: an integer is missing"},
          {head + three + "3 0 1 3\n",
           "line 13, face 0: index 3 is out of range; the file has 3 vertices"},
          {head + three + "256 0 1 2\n",
           "line 13, face 0: a list of 256 values; its type holds 0 to 255"},
          {head + three + "-1 0 1 2\n",
           "line 13, face 0: a list of -1 values; its type holds 0 to 255"},
          {head + three + std::string("3 0 1 \0\n", 8),
           "byte " + std::to_string(head.size() + three.size() + 6) + ": NUL byte in text"},
          {header("ascii", "element vertex 1\n" + kXyz + "property int a\n") + "0 0 0\n   ",
           "line 9, vertex 0: fewer values than the header declares"},
          {header("ascii", "element vertex 0\n" + kXyz) + "0 0 0\n",
           "header: no faces are declared, but more data follow"},
      },
      "m.ply");
}

TEST(ReadPly, RefusesBinaryWithByteAndElement) {
  const auto little = std::endian::little;
  const std::string head = usual_header("binary_little_endian");
  const std::string body = binary_body(little);
  const auto at = [&](std::size_t offset) {
    return "byte " + std::to_string(head.size() + offset);
  };
  std::string infinite = body;
  infinite.replace(4, 4, pack(little, std::numeric_limits<float>::infinity()));
  std::string beyond = body;
  beyond.replace(37, 4, pack(little, 0xffffffffU));
  expect_refused(
      {
          {head + infinite, at(4) + ", vertex 0: coordinate is not finite"},
          {head + beyond, at(37) + ", face 0: index -1 is out of range; the file has 3 vertices"},
          {head + body.substr(0, 36),
           at(36) + ", face 0: truncated: 1 bytes are needed, 0 are left"},
          {head + body.substr(0, 36) + "\xff", at(36) + ", face 0: 255 values are declared, more "
                                                        "than the file can hold"},
      },
      "m.ply");
}

}  // namespace
}  // namespace timbre

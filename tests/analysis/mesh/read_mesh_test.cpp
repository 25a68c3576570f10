#include "timbre/analysis/mesh/read_mesh.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/mesh/diagnosis.h"
#include "timbre/analysis/mesh/write_mesh.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/read_text.h"
#include "timbre/tests/support/shared_data.h"
#include "timbre/tests/support/temporary_folder.h"

namespace timbre {
namespace {

const std::string kOff = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kStl =
    "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
    "endfacet\nendsolid\n";

std::string binary_stl() {
  std::string bytes(84 + 50, '\0');
  bytes[80] = 1;
  bytes[84 + 12 + 12 + 3] = 0x3f;  // x of the second corner: 0.5
  bytes[84 + 12 + 24 + 7] = 0x3f;  // y of the third
  return bytes;
}

std::string binary_off() {
  std::string bytes = "OFF BINARY\n";
  const auto add = [&bytes](std::initializer_list<int> values) {
    for (const int value : values)
      bytes += std::string({'\0', '\0', '\0', static_cast<char>(value)});
  };
  add({3, 1, 0, 0, 0, 0});
  bytes += std::string("\x3f\x80\0\0", 4);
  add({0, 0, 0});
  bytes += std::string("\x3f\x80\0\0", 4);
  add({0, 3, 0, 1, 2, 0});
  return bytes;
}

std::string gzip_stored(const std::string& content) {
  const auto number = [](std::uint64_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 0xff);
    return text;
  };
  const auto size = content.size();
  return std::string("\x1f\x8b\x08\0\0\0\0\0\0\3\1", 11) + number(size, 2) + number(~size, 2) +
         content + number(crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), size), 4) +
         number(size, 4);
}

TEST(ReadMesh, KnowsFormatsByContentUnderAnyName) {
  for (const char* name : {"m", "m.off", "m.obj", "m.ply", "m.stl", "m.txt", "-"}) {
    EXPECT_EQ(read_mesh_bytes(kOff, name).format, "off") << name;
    EXPECT_EQ(read_mesh_bytes(kObj, name).format, "obj") << name;
    EXPECT_EQ(read_mesh_bytes(kPly, name).format, "ply") << name;
    EXPECT_EQ(read_mesh_bytes(kStl, name).format, "stl") << name;
    EXPECT_EQ(read_mesh_bytes(binary_stl(), name).format, "stl") << name;
    EXPECT_EQ(read_mesh_bytes(binary_off(), name).format, "off") << name;
  }
  EXPECT_EQ(read_mesh_bytes("l 1 2\n" + kObj, "m.obj").format, "obj");
}

TEST(ReadMesh, SkipsAByteOrderMark) {
  for (const std::string& text : {kOff, kObj, kPly, kStl}) {
    EXPECT_EQ(read_mesh_bytes("\xef\xbb\xbf" + text, "m").mesh.faces.rows(), 1);
  }
}

TEST(ReadMesh, SaysWhatAFileSeemsToBe) {
  const std::string unknown =
      "line 1: no known format; OFF, OBJ, PLY, STL, FreeSurfer, VTK and GLB are read, also with "
      ".gz";
  expect_refused(
      {
          {"", "byte 0: the file is empty"},
          {" \n\t\n", "end of file: nothing but white space and comments"},
          {"\xef\xbb\xbf", "end of file: nothing but white space and comments"},
          {"# only this\n", "end of file: nothing but white space and comments"},
          {"1 2 3\n", unknown},
          {"XOFF\n", unknown},
          {"CSTOFF\n", unknown},
          {"OFFx\n", unknown},
          {"plyx\n", unknown},
          {std::string("\xff\xfev\0", 4), "byte 0: UTF-16 text; save it as UTF-8"},
          {std::string("\xfe\xff\0v", 4), "byte 0: UTF-16 text; save it as UTF-8"},
          {"\n<!DOCTYPE html>", "line 1: a web page or XML, not a mesh; download the file itself"},
          {"<html>", "line 1: a web page or XML, not a mesh; download the file itself"},
          {"<?xml ?>", "line 1: a web page or XML, not a mesh; download the file itself"},
          {"\n {\"asset\": {}}", "line 1: glTF or other JSON as text; save it as binary .glb"},
          {"version https://git-lfs.github.com/spec/v1\n",
           "line 1: a Git LFS pointer, not the mesh itself; fetch it with 'git lfs pull'"},
          {"\x1f\x8b\x08", "byte 0: gzip data; it is unpacked when the name ends in .gz"},
          {std::string("ab\0c", 4), "byte 2: NUL byte in text"},
          {std::string("#\0\n", 3) + kOff, "byte 1: NUL byte in text"},
      },
      "m.dat");
  EXPECT_EQ(refusal("short", "m.stl"),
            "m.stl: end of file: truncated: a binary STL has at least 84 bytes");
}

TEST(ReadMesh, UnpacksGzipByName) {
  EXPECT_EQ(summary(read_mesh_bytes(gzip_stored(kOff), "m.off.gz")), "3/1");
  EXPECT_EQ(summary(read_mesh_bytes(gzip_stored(binary_stl()), "m.stl.GZ")), "3/1");
  EXPECT_EQ(summary(read_mesh_bytes(gzip_stored(kOff), "-")), "3/1");
  EXPECT_EQ(refusal(kOff, "m.off.gz"),
            "m.off.gz: byte 0: no gzip data, though the name ends in .gz");
  EXPECT_EQ(refusal("", "m.off.gz"), "m.off.gz: byte 0: the file is empty");
  EXPECT_EQ(refusal(gzip_stored(kOff).substr(0, 30), "m.off.gz"), "m.off.gz: gzip: truncated");
  EXPECT_EQ(refusal(gzip_stored(gzip_stored(kOff)), "m.gz"),
            "m.gz: byte 0: gzip data; it is unpacked when the name ends in .gz");
  EXPECT_EQ(refusal(gzip_stored(kOff), "m.off.gz", {.size_limit = 20}),
            "m.off.gz: gzip: expands beyond the limit of 20 bytes");
}

TEST(ReadMesh, ReadsFilesAndNamesThemInErrors) {
  const TemporaryFolder folder;
  put_file(folder / "a\nb.off", kOff);
  put_file(folder / "bad.off.gz", kOff);
  put_file(folder / "bad.off", "OFF\n1 0 0\n0 0 x\n");
  put_file(folder / "m.off.gz", gzip_stored(kOff));
  EXPECT_EQ(summary(read_mesh(folder / "a\nb.off")), "3/1");
  EXPECT_EQ(summary(read_mesh(folder / "m.off.gz")), "3/1");
  for (const std::string name : {"bad.off.gz", "bad.off", "none.off"}) {
    try {
      (void)read_mesh(folder / name);
      ADD_FAILURE() << "no exception";
    } catch (const Error& error) {
      EXPECT_EQ(error.file(), folder / name);
      EXPECT_FALSE(error.place().empty());
    }
  }
}

TEST(ReadMesh, ReadsPastALongPreamble) {
  const TemporaryFolder folder;
  for (const std::size_t length : {4090U, 4093U, 4096U, 10000U}) {
    put_file(folder / "a.off", std::string(length, ' ') + kOff);
    EXPECT_EQ(summary(read_mesh(folder / "a.off")), "3/1") << length;
    put_file(folder / "a.off", "#" + std::string(length, 'x') + "\n" + kOff);
    EXPECT_EQ(summary(read_mesh(folder / "a.off")), "3/1") << length;
  }
}

TEST(ReadMesh, RefusesASparseFileByItsFirstBytes) {
  const TemporaryFolder folder;
  for (const std::string name : {"a.off", "a.stl"}) {
    put_file(folder / name, "");
    std::filesystem::resize_file(folder / name, std::uintmax_t{3} << 30);
    EXPECT_THROW((void)read_mesh(folder / name), Error);
  }
}

TEST(ReadMesh, SplitsPolygonsWhereTheyStood) {
  const MeshFile file = read_mesh_bytes(
      "OFF 6 3 0\n0 0 0\n4 0 0\n1 1 0\n0 4 0\n5 5 5\n6 6 7\n3 0 1 2\n4 0 1 2 3\n3 3 4 5\n", "m");
  EXPECT_EQ(summary(file), "6/4 triangulated=1");
  EXPECT_EQ(file.mesh.faces.row(0), Eigen::RowVector3i(0, 1, 2));
  EXPECT_EQ(file.mesh.faces.row(3), Eigen::RowVector3i(3, 4, 5));
  EXPECT_DOUBLE_EQ(
      twice_signed_area_z({file.mesh.vertices, Faces(file.mesh.faces.middleRows(1, 2))}), 8.0);
}

TEST(ReadMesh, WarnsOfOddFacesAndVerticesWithTheirNumbers) {
  const MeshFile file = read_mesh_bytes(
      "OFF 7 7 0\n0 0 0\n1 0 0\n0 1 0\n-0 0 0\n2 0 0\n9 9 9\n8 8 8\n"
      "3 0 1 2\n3 2 0 1\n3 1 0 2\n3 0 1 4\n3 0 0 3\n4 0 1 2 0\n2 5 5\n",
      "m");
  EXPECT_EQ(summary(file),
            "7/7 coincident-vertex=1 degenerate-face=3 dropped-element=1 duplicate-face=2 "
            "triangulated=1 unused-vertex=2");
  EXPECT_EQ(file.warnings[0].message, "vertices at the position of an earlier one: 1 (vertex 3)");
  EXPECT_EQ(file.warnings[1].message, "faces without area: 3 (face 3, 4, 5)");
  EXPECT_EQ(file.warnings[3].message, "faces with the corners of an earlier one: 2 (face 1, 2)");
  EXPECT_EQ(file.warnings[5].message, "vertices in no face: 2 (vertex 5, 6)");
}

TEST(ReadMesh, NamesOnlyTheFirstPlaces) {
  std::string text = "OFF 8 1 0\n";
  for (int i = 0; i < 8; ++i) text += std::to_string(i) + " 0 " + std::to_string(i * i) + "\n";
  const MeshFile file = read_mesh_bytes(text + "3 0 1 2\n", "m");
  EXPECT_EQ(file.warnings[0].message, "vertices in no face: 5 (vertex 3, 4, 5, 6, 7)");
  const MeshFile more = read_mesh_bytes(text + "3 0 1 0\n", "m");
  EXPECT_EQ(more.warnings[1].message, "vertices in no face: 6 (vertex 2, 3, 4, 5, 6, ...)");
}

TEST(ReadMesh, WarnsOfNothingAtAnyScale) {
  for (const double scale : {1e-200, 1e-100, 1.0, 1e100, 1e300}) {
    TriangleMesh mesh = torus(9, 7);
    mesh.vertices *= scale;
    EXPECT_EQ(codes(read_mesh_bytes(to_mesh_bytes(mesh, MeshFormat::ply), "m")), "");
  }
}

TEST(ReadMesh, DoesNotCareWhereAFileIsCut) {
  for (const std::string& whole : {kOff, kObj, kPly, kStl, binary_stl(), binary_off(),
                                   to_mesh_bytes(tetrahedron(), MeshFormat::ply)}) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      try {
        const MeshFile file = read_mesh_bytes(whole.substr(0, size), "m");
        EXPECT_LE(file.mesh.faces.rows(), 4);
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      }
    }
  }
}

// Whatever the bytes: a mesh whose numbers are sound, or one line.
void expect_sound(const std::string& bytes) {
  try {
    const MeshFile file = read_mesh_bytes(bytes, "m.obj");
    ASSERT_TRUE(file.mesh.vertices.allFinite());
    if (file.mesh.faces.size() > 0) {
      ASSERT_GE(file.mesh.faces.minCoeff(), 0);
      ASSERT_LT(file.mesh.faces.maxCoeff(), file.mesh.vertices.rows());
    }
    (void)diagnose(file.mesh);
  } catch (const Error& error) {
    ASSERT_EQ(error.kind(), ErrorKind::bad_input);
    const std::string line = error.what();
    ASSERT_EQ(line.find_first_of(std::string("\0\n\r\x1b", 4)), std::string::npos);
    ASSERT_LT(line.size(), 400U);
  }
}

TEST(ReadMesh, SurvivesTwentyThousandMutations) {
  const std::string quads = to_mesh_bytes(grid(3), MeshFormat::off) + "5 0 1 6 5 4\n";
  const std::vector<std::string> seeds = {kOff,
                                          kObj + "f 1//1 2//2 -1/3/4\n",
                                          kPly,
                                          kStl,
                                          binary_stl(),
                                          binary_off(),
                                          quads,
                                          "STCN4OFF 1 1\n1 2 3 4 0 0 1 1 1 1 0 0\n1 0\n",
                                          to_mesh_bytes(tetrahedron(), MeshFormat::ply)};
  const std::vector<std::string> tokens = {"-1",
                                           "4294967297",
                                           "1e999",
                                           "nan",
                                           "\n",
                                           "\r",
                                           "#",
                                           "\\\n",
                                           "0",
                                           "/",
                                           "end_header\n",
                                           "list",
                                           std::string(1, '\0'),
                                           "\xff\xff\xff\xff",
                                           "BINARY",
                                           "99999999999999999999"};
  std::mt19937 random(2024);
  const auto below = [&random](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  for (int trial = 0; trial < 20000; ++trial) {
    std::string bytes = seeds[below(seeds.size())];
    for (std::size_t edits = 1 + below(4); edits > 0 && !bytes.empty(); --edits) {
      const std::size_t at = below(bytes.size());
      switch (below(5)) {
        case 0:
          bytes[at] = static_cast<char>(random());
          break;
        case 1:
          bytes.erase(at, 1 + below(8));
          break;
        case 2:
          bytes.insert(at, tokens[below(tokens.size())]);
          break;
        case 3:
          bytes.insert(at, bytes.substr(below(bytes.size()), below(40)));
          break;
        default:
          bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
      }
    }
    ASSERT_NO_FATAL_FAILURE(expect_sound(bytes)) << "trial " << trial;
  }
}

TEST(ReadMesh, DoesNotAllocateForPromises) {
  for (const char* text : {"OFF 2000000000 2000000000 0\n", "OFF 9223372036854775807 1 0\n",
                           "OFF 1 1 0\n0 0 0\n2000000000 0\n"}) {
    EXPECT_THROW((void)read_mesh_bytes(text, "m"), Error);
  }
}

// The corpus states for each file what must come of it; see its README.
TEST(ReadMesh, DoesJusticeToTheHostileCorpus) {
  TIMBRE_NEEDS_SHARED_DATA("hostile/manifest.tsv");
  std::ifstream manifest(shared_data() / "hostile/manifest.tsv");
  std::string line;
  std::getline(manifest, line);
  int files = 0;
  while (std::getline(manifest, line)) {
    std::istringstream fields(line);
    std::string name, outcome, vertices, triangles, warnings, area;
    for (std::string* field : {&name, &outcome, &vertices, &triangles, &warnings, &area}) {
      std::getline(fields, *field, '\t');
    }
    ++files;
    try {
      const MeshFile file = read_mesh((shared_data() / "hostile/files" / name).string());
      EXPECT_EQ(outcome, "ok") << name;
      EXPECT_EQ(std::to_string(file.mesh.vertices.rows()), vertices) << name;
      EXPECT_EQ(std::to_string(file.mesh.faces.rows()), triangles) << name;
      std::string found = codes(file);
      std::replace(found.begin(), found.end(), ' ', ',');
      EXPECT_EQ(found.empty() ? "-" : found, warnings) << name;
      if (const auto expected = parse_double(area)) {
        EXPECT_NEAR(diagnose(file.mesh).area, *expected, 1e-5 * *expected) << name;
      }
    } catch (const Error& error) {
      EXPECT_EQ(outcome, "error") << error.what();
    }
  }
  EXPECT_GT(files, 400);
}

}  // namespace
}  // namespace timbre

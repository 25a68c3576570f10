#include <gtest/gtest.h>

#include <limits>

#include "timbre/analysis/mesh/write_mesh.h"
#include "timbre/tests/support/byte_order.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/read_text.h"

namespace timbre {
namespace {

MeshFile read(const std::string& bytes) { return read_mesh_bytes(bytes, "m.vtk"); }

const std::string kText = "# vtk DataFile Version 3.0\na title\nASCII\n";
const std::string kBinary = "# vtk DataFile Version 3.0\na title\nBINARY\n";
const std::string kSquare = "POINTS 4 float\n0 0 0 1 0 0\n1 1 0 0 1 0\n";
const std::string kSheet = kText + "DATASET POLYDATA\n" + kSquare;
const std::string kGrid = kText + "DATASET UNSTRUCTURED_GRID\n" + kSquare;

std::string grid_of(const std::string& cell, int numbers, int type) {
  return kGrid + "CELLS 1 " + std::to_string(numbers) + "\n" + cell + "\nCELL_TYPES 1\n" +
         std::to_string(type) + "\n";
}

TEST(ReadVtk, ReadsPolygons) {
  const MeshFile file = read(kSheet + "POLYGONS 2 9\n3 0 1 2\n4 3 2 1 0\n");
  EXPECT_EQ(file.format, "vtk");
  EXPECT_EQ(summary(file), "4/3 triangulated=1");
  EXPECT_EQ(file.mesh.vertices.row(3), Eigen::RowVector3d(0, 1, 0));
  EXPECT_EQ(file.mesh.faces.row(0), Eigen::RowVector3i(0, 1, 2));
  EXPECT_EQ(summary(read_mesh_bytes(kSheet + "POLYGONS 1 4\n3 0 1 2\n", "m.off")),
            "4/1 unused-vertex=1");
}

TEST(ReadVtk, TurnsEveryOtherTriangleOfAStrip) {
  const MeshFile file = read(kSheet + "TRIANGLE_STRIPS 2 8\n4 0 1 3 2 2 0 1\n");
  EXPECT_EQ(summary(file), "4/2 dropped-element=1");
  EXPECT_EQ(file.mesh.faces.row(0), Eigen::RowVector3i(0, 1, 3));
  EXPECT_EQ(file.mesh.faces.row(1), Eigen::RowVector3i(3, 1, 2));
}

TEST(ReadVtk, DropsPointsAndLines) {
  EXPECT_EQ(summary(read(kSheet + "VERTICES 1 2\n1 0\nLINES 1 4\n3 0 1 2\nPOLYGONS 1 5\n"
                                  "4 0 1 2 3\n")),
            "4/2 dropped-element=2 triangulated=1");
}

TEST(ReadVtk, ReadsTheFacesOfAGrid) {
  const auto faces = [](const std::string& cell, int numbers, int type) {
    return summary(read(grid_of(cell, numbers, type)));
  };
  EXPECT_EQ(faces("3 0 1 2", 4, 5), "4/1 unused-vertex=1");
  EXPECT_EQ(faces("4 0 1 3 2", 5, 6), "4/2");
  EXPECT_EQ(faces("4 0 1 2 3", 5, 7), "4/2 triangulated=1");
  EXPECT_EQ(faces("4 0 1 3 2", 5, 8), "4/2 triangulated=1");
  EXPECT_EQ(faces("4 0 1 2 3", 5, 9), "4/2 triangulated=1");
  EXPECT_EQ(faces("2 0 1", 3, 3), "4/0 dropped-element=1 no-faces=1");
}

TEST(ReadVtk, ReadsOffsetsAndConnectivity) {
  EXPECT_EQ(summary(read(kSheet + "METADATA\nINFORMATION 0\n\nPOLYGONS 3 6\n"
                                  "OFFSETS vtktypeint64\n0 3 6\n"
                                  "CONNECTIVITY vtktypeint64\n0 1 2 0 2 3\n")),
            "4/2");
  EXPECT_EQ(
      summary(read(kBinary + "DATASET POLYDATA\nPOINTS 3 short\n" +
                   big_endian<std::int16_t>({0, 0, 0, -1, 0, 0, 0, 1, 0}) +
                   "\nPOLYGONS 2 3\nOFFSETS vtktypeint64\n" + big_endian<std::int64_t>({0, 3}) +
                   "\nCONNECTIVITY vtktypeint32\n" + big_endian({0, 1, 2}) + "\n")),
      "3/1");
}

TEST(ReadVtk, PassesOverFieldsAndData) {
  const std::string field = "FIELD FieldData 2\nTIME 1 1 double\n0.5\nNAME 2 2 int\n1 2\n3 4\n";
  EXPECT_EQ(summary(read(kText + "DATASET POLYDATA\n" + field + kSquare +
                         "POLYGONS 1 4\n3 0 1 2\nPOINT_DATA 4\nSCALARS a float\nnan\n")),
            "4/1 unused-vertex=1");
}

TEST(ReadVtk, RefusesWithPlaceAndCause) {
  const float inf = std::numeric_limits<float>::infinity();
  const std::string sheet = kText + "DATASET POLYDATA\n";
  expect_refused(
      {
          {kText, "end of file: truncated"},
          {"# vtk DataFile Version 3.0\n\nTEXT\n", "line 3: 'ASCII' or 'BINARY' is needed"},
          {kText + "POINTS\n", "line 4: 'DATASET' is needed"},
          {kText + "DATASET STRUCTURED_GRID\n",
           "line 4: 'structured_grid' has no faces; POLYDATA and UNSTRUCTURED_GRID are read"},
          {sheet, "end of file: truncated: POINTS are missing"},
          {kSheet, "end of file: truncated: POLYGONS are missing"},
          {kGrid, "end of file: truncated: CELLS and CELL_TYPES are missing"},
          {kSheet + "CELLS 1 4\n", "line 8: 'cells' is no section of this dataset"},
          {kSheet + kSquare, "line 8: POINTS stand twice"},
          {sheet + "POLYGONS 1 4\n", "line 5: POINTS must stand before the cells"},
          {sheet + "POINTS 1 word\n0 0 0", "line 5: 'word' is no type of numbers"},
          {sheet + "POINTS 9 float\n0 0 0",
           "line 5: 9 points are declared, which the file cannot hold"},
          {sheet + "POINTS -1 float\n0 0 0",
           "line 5: -1 points are declared, which the file cannot hold"},
          {sheet + "POINTS 1 float\n0 0 nan",
           "line 6, vertex 0: 'nan' is not a decimal number in the range of a double"},
          {sheet + "POINTS 1 float\n0 0  \n  ", "end of file: truncated: vertex 0 is missing"},
          {kSheet + "POLYGONS 1 4\n3 0 1 4\n",
           "line 9, cell 0: index 4 is out of range; the file has 4 vertices"},
          {kSheet + "POLYGONS 1 4\n4 0 1 2 3\n",
           "line 9, cell 0: 4 corners; the declared size has room for 3"},
          {kSheet + "POLYGONS 1 5\n3 0 1 2\n",
           "line 9: the cells leave 1 of the declared numbers over"},
          {kSheet + "POLYGONS 2 3\nOFFSETS vtktypeint64\n0 4\n",
           "line 10, offset 1: 4 is no offset; they rise from 0 to 3"},
          {kSheet + "POLYGONS 2 3\nOFFSETS vtktypeint64\n0 2\n",
           "line 10: the last offset is 2, not the size 3"},
          {kSheet + "POLYGONS 2 3\nOFFSETS vtktypeint64\n0 3\nPOINTS\n",
           "line 11: 'CONNECTIVITY' is needed"},
          {kSheet + "POLYGONS 2 3\nOFFSETS float\n0 3\n", "line 9: a type of integers is needed"},
          {kGrid + "CELL_TYPES 1\n5\n", "line 8: 1 cell types for 0 cells"},
          {grid_of("3 0 1 2", 4, 5) + "CELL_TYPES 1\n5\n", "line 12: CELL_TYPES stand twice"},
          {grid_of("4 0 1 2 3", 5, 10),
           "line 11, cell 0: a cell of type 10 is a volume or curved; extract the surface as flat "
           "faces first"},
          {grid_of("4 0 1 2 3", 5, 5), "line 11, cell 0: 4 corners; a cell of type 5 has 3"},
          {kBinary + "DATASET POLYDATA\nPOINTS 1 float\n" + big_endian<float>({0, inf, 0}),
           "byte 78, vertex 0: coordinate is not finite"},
          {kSheet + std::string(1, '\0'), "byte 97: NUL byte in text"},
      },
      "m.vtk");
}

TEST(ReadVtk, SeesEveryCut) {
  expect_cuts_are_seen(kSheet + "POLYGONS 1 4\n3 0 1 2\nPOINT_DATA 4\n", "m.vtk");
  expect_cuts_are_seen(grid_of("4 0 1 2 3", 5, 9), "m.vtk");
  expect_cuts_are_seen(to_mesh_bytes(tetrahedron(), MeshFormat::vtk), "m.vtk");
}

}  // namespace
}  // namespace timbre

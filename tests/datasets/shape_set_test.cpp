#include "timbre/datasets/shape_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "timbre/tests/support/set_folder.h"

namespace timbre {
namespace {

using Names = std::vector<std::string>;

Names names_of(const ShapeSet& set) {
  Names names;
  for (const SetShape& shape : set.shapes) names.push_back(shape.name);
  return names;
}

Names labels_of(const ShapeSet& set) {
  Names labels;
  for (const SetShape& shape : set.shapes) labels.push_back(shape.label);
  return labels;
}

ShapeSet set_of(const SetFolder& folder) { return read_shape_set(folder.path().string()); }

std::string refused(const SetFolder& folder, ErrorKind kind = ErrorKind::bad_input) {
  return refusal_of(folder, kind, [&] { (void)set_of(folder); });
}

struct Named {
  const char* about;
  Names files;
  SetLayout layout;
  Names labels;
};

class LayoutByNames : public testing::TestWithParam<Named> {};

TEST_P(LayoutByNames, IsRecognised) {
  const SetFolder folder;
  folder.put_meshes(GetParam().files);
  const ShapeSet set = set_of(folder);
  EXPECT_EQ(names_of(set), GetParam().files) << GetParam().about;
  EXPECT_STREQ(to_word(set.layout), to_word(GetParam().layout));
  EXPECT_EQ(labels_of(set), GetParam().labels);
}

INSTANTIATE_TEST_SUITE_P(
    Names, LayoutByNames,
    testing::Values(
        Named{"FAUST",
              {"tr_reg_000.ply", "tr_reg_019.ply", "tr_reg_020.ply"},
              SetLayout::faust,
              {"0", "1", "2"}},
        Named{"SCAPE", {"mesh000.ply", "mesh071.ply"}, SetLayout::scape, {"scape", "scape"}},
        Named{"SHREC",
              {"1.off", "20.off", "21.off", "400.off"},
              SetLayout::shrec,
              {"1", "1", "2", "20"}},
        Named{"SHREC ends at 400", {"1.off", "401.off"}, SetLayout::plain, {"", ""}},
        Named{"a number beyond all", {"99999999999999999999999.off"}, SetLayout::plain, {""}},
        Named{"TOSCA",
              {"cat0.off", "cat2.off", "cat10.off", "wolf1.off"},
              SetLayout::words,
              {"cat", "cat", "cat", "wolf"}},
        Named{"SMAL",
              {"lion_1.ply", "lion_2.ply", "tiger-03.ply"},
              SetLayout::words,
              {"lion", "lion", "tiger"}},
        Named{"one name without number", {"cat0.off", "teapot.off"}, SetLayout::plain, {"", ""}},
        Named{"packed", {"cat0.ply.gz", "cat1.PLY"}, SetLayout::words, {"cat", "cat"}},
        Named{"dots", {"cat.v2.0.off", "cat.v2.1.off"}, SetLayout::words, {"cat.v2.", "cat.v2."}}));

TEST(ReadShapeSet, TakesLabelsFromAListByFileOrStem) {
  for (const char* list : {"labels.txt", "classes.txt"}) {
    const SetFolder folder;
    folder.put_meshes({"a.off", "b.ply.gz", "c.off", "d.off"});
    folder.put(list,
               "\xef\xbb\xbf"
               "a.off cat 0\r\n\r\nb\tdog\r\nc.off ?");
    const ShapeSet set = set_of(folder);
    EXPECT_EQ(set.layout, SetLayout::listed);
    EXPECT_EQ(labels_of(set), (Names{"cat", "dog", "", ""}));
    EXPECT_EQ(set.truth_folder, folder.path().string());
  }
}

TEST(ReadShapeSet, TakesClassesFromAClaFile) {
  const SetFolder folder;
  folder.put_meshes({"T0.off", "T1.off", "T2.off", "T10.off"});
  folder.put("test.cla", "PSB 1\n3 3\n\nanimal 0 0\n\ncat animal 2\n10\n0\n\nwolf animal 1\n1\n");
  const ShapeSet set = set_of(folder);
  EXPECT_EQ(set.layout, SetLayout::cla);
  EXPECT_EQ(labels_of(set), (Names{"cat", "wolf", "", "cat"}));
  EXPECT_EQ(set.pairs, (decltype(set.pairs){{"T0.off", "T10.off"}}));
}

TEST(ReadShapeSet, FindsMeshesInFoldersAndTruthApart) {
  const SetFolder faust;
  faust.put_meshes({"training/registrations/tr_reg_000.ply"});
  EXPECT_EQ(set_of(faust).truth_folder, faust / "training/registrations");
  const SetFolder remeshed;
  remeshed.put_meshes({"off/cat0.off", "off/cat1.off"});
  remeshed.put("corres/cat0.vts", "1\n");
  remeshed.put("labels.txt", "cat0.off cat\ncat1 cat\n");
  const ShapeSet set = set_of(remeshed);
  EXPECT_EQ(set.shapes[0].file, remeshed / "off/cat0.off");
  EXPECT_EQ(set.truth_folder, remeshed / "corres");
  EXPECT_EQ(set.layout, SetLayout::listed);
}

TEST(ReadShapeSet, LeavesOutWhatIsNoMeshFile) {
  const SetFolder folder;
  folder.put_meshes({"a1.off", ".off", "._a1.off", "a1.vts", "b1.off/inner.off", "c.vert.gz"});
  EXPECT_EQ(names_of(set_of(folder)), Names{"a1.off"});
}

TEST(ReadShapeSet, ReadsPairsAndColumnsOfSymmetry) {
  const SetFolder folder;
  folder.put_meshes({"cat0.off", "cat1.off", "dog0.off"});
  folder.put("pairs.txt", "dog0.off cat1.off\r\ncat0 cat1\n\n");
  folder.put("symmetry.txt", "cat dog\n1 1\n");
  const ShapeSet set = set_of(folder);
  EXPECT_TRUE(set.pairs_listed);
  EXPECT_EQ(set.pairs, (decltype(set.pairs){{"dog0.off", "cat1.off"}, {"cat0.off", "cat1.off"}}));
  EXPECT_EQ(set.symmetry_columns, (Names{"cat", "dog"}));
}

TEST(ReadShapeSet, PairsShapesOfOneLabel) {
  const SetFolder folder;
  folder.put_meshes({"cat0.off", "cat1.off", "cat2.off", "dog0.off", "dog1.off", "wolf0.off"});
  const ShapeSet set = set_of(folder);
  EXPECT_FALSE(set.pairs_listed);
  const std::set<std::pair<std::string, std::string>> pairs(set.pairs.begin(), set.pairs.end());
  EXPECT_EQ(pairs, (decltype(pairs){{"cat0.off", "cat1.off"},
                                    {"cat0.off", "cat2.off"},
                                    {"cat1.off", "cat2.off"},
                                    {"dog0.off", "dog1.off"}}));
  EXPECT_EQ(set.pairs.size(), pairs.size());
  EXPECT_EQ(set_of(folder).pairs, set.pairs);
}

TEST(ReadShapeSet, PairsAllOfFaustAndAllWithoutLabelsButNoneUnknown) {
  const SetFolder faust;
  faust.put_meshes({"tr_reg_000.ply", "tr_reg_010.ply", "tr_reg_020.ply"});
  EXPECT_EQ(set_of(faust).pairs.size(), 3U);
  const SetFolder plain;
  plain.put_meshes({"a.ply", "b.ply", "c.ply"});
  EXPECT_EQ(set_of(plain).pairs.size(), 3U);
  plain.put("labels.txt", "a.ply ?\nb.ply ?\nc.ply ?\n");
  EXPECT_EQ(set_of(plain).pairs.size(), 0U);
}

TEST(ReadShapeSet, ChoosesAmongTooManyPairs) {
  const SetFolder folder;
  constexpr int kShapes = 700;  // 244,650 pairs
  for (int i = 0; i < kShapes; ++i) folder.put("s" + std::to_string(i) + ".off", "");
  const ShapeSet set = set_of(folder);
  const std::set<std::pair<std::string, std::string>> pairs(set.pairs.begin(), set.pairs.end());
  EXPECT_EQ(static_cast<std::int64_t>(pairs.size()), kMostPairs);
  EXPECT_EQ(set_of(folder).pairs, set.pairs);
  EXPECT_TRUE(std::none_of(pairs.begin(), pairs.end(),
                           [](const auto& pair) { return pair.first == pair.second; }));
}

TEST(ReadShapeSet, TakesALargeFolderInItsStride) {
  const SetFolder folder;
  std::string labels;
  constexpr int kShapes = 20000;
  for (int i = 0; i < kShapes; ++i) {
    folder.put("s" + std::to_string(i) + ".off", "");
    labels += "s" + std::to_string(i) + ".off c" + std::to_string(i % 7) + "\n";
  }
  folder.put("labels.txt", labels);
  const ShapeSet set = set_of(folder);
  EXPECT_EQ(set.shapes.size(), static_cast<std::size_t>(kShapes));
  EXPECT_EQ(set.shapes[kShapes - 1].label, "c" + std::to_string((kShapes - 1) % 7));
}

TEST(ReadShapeSet, SaysWhyAFolderIsNoSet) {
  const SetFolder folder;
  EXPECT_EQ(refused(folder),
            "SET: holds no mesh (.off, .obj, .ply, .stl, .vtk, .glb, .vert with .tri), nor do its "
            "folders off, shapes, meshes, registrations");
  EXPECT_EQ(refusal_of(folder, ErrorKind::io, [&] { (void)read_shape_set(folder / "none"); }),
            "SET/none: No such file or directory");
  folder.put("file", "");
  EXPECT_EQ(refusal_of(folder, ErrorKind::io, [&] { (void)read_shape_set(folder / "file"); }),
            "SET/file: Not a directory");
}

struct BrokenList {
  const char* name;
  std::string content;
  std::string line;
};

class ABrokenList : public testing::TestWithParam<BrokenList> {};

TEST_P(ABrokenList, IsRefusedWithItsLine) {
  const SetFolder folder;
  folder.put_meshes({"T1.off", "T2.off", "T my cat.off"});
  if (std::string(GetParam().name).ends_with(".cla")) {
    std::filesystem::remove(folder / "T my cat.off");
  }
  folder.put(GetParam().name, GetParam().content);
  EXPECT_EQ(refused(folder), "SET/" + std::string(GetParam().name) + ": " + GetParam().line);
}

using namespace std::string_literals;

INSTANTIATE_TEST_SUITE_P(
    Lists, ABrokenList,
    testing::Values(
        BrokenList{"labels.txt", "T1.off a\nT3.off b\n", "line 2: 'T3.off' is not in the folder"},
        BrokenList{"labels.txt", "\n\nT1.off\n", "line 3: has no label after the file"},
        BrokenList{"labels.txt", "T1.off a\nT1.off a\nT1 b\n",
                   "line 3: labels T1.off a second time"},
        BrokenList{"labels.txt", "T my cat.off cat\n",
                   "line 1: 'T' is not in the folder; lists cannot hold names with blanks or "
                   "commas: rename the file"},
        BrokenList{"classes.txt", "\0\x01\x02 x"s,
                   R"(line 1: '\x00\x01\x02' is not in the folder)"},
        BrokenList{"classes.txt",
                   "T1.off " + std::string(5000, ' ') + "a" +
                       [] {
                         std::string words;
                         for (int i = 0; i < 1000; ++i) words += " w";
                         return words;
                       }(),
                   "line 1: has more than 1000 words"},
        BrokenList{"pairs.txt", "T1.off T2.off\nT1.off\n", "line 2: two files are wanted"},
        BrokenList{"pairs.txt", "T1.off T2.off T1.off\n", "line 1: two files are wanted"},
        BrokenList{"pairs.txt", "T1.off none.off\n", "line 1: 'none.off' is not in the folder"},
        BrokenList{"pairs.txt", "T1.off T2.off\nT1 T2\n", "line 2: names this pair a second time"},
        BrokenList{"symmetry.txt", " \n", "is empty"},
        BrokenList{"a.cla", "", "is no whole PSB class file"},
        BrokenList{"a.cla", "\0\xff\xfe\n1 2 3\n"s, "is no whole PSB class file"},
        BrokenList{"a.cla", "PSB 1\n1 2\nx 0 2\n1\n", "is no whole PSB class file"},
        BrokenList{"a.cla", "PSB 1\n1 2\nx 0 2\n1\ny\n", "line 5: the number of a model is wanted"},
        BrokenList{"a.cla", "PSB 1\n1 2\nx 0\n", "line 3: a class (name parent count) is wanted"},
        BrokenList{"a.cla", "PSB 1\n1 2\nx 0 -1\n",
                   "line 3: a class (name parent count) is wanted"},
        BrokenList{"a.cla", "PSB 1\n1 2\nx 0 99999999999999999999\n",
                   "line 3: a class (name parent count) is wanted"}));

TEST(ReadShapeSet, TakesEmptyLists) {
  const SetFolder folder;
  folder.put_meshes({"cat0.off", "cat1.off"});
  folder.put("labels.txt", "");
  folder.put("pairs.txt", "\n");
  const ShapeSet set = set_of(folder);
  EXPECT_EQ(labels_of(set), (Names{"", ""}));
  EXPECT_TRUE(set.pairs_listed);
  EXPECT_TRUE(set.pairs.empty());
}

TEST(ReadShapeSet, KeepsAnyName) {
  const SetFolder folder;
  const Names names = {"caf\xe9 1.off", "k\xc3\xa4se 2.off", "new\nline 3.off"};
  folder.put_meshes(names);
  Names found = names_of(set_of(folder));
  Names wanted = names;
  std::sort(found.begin(), found.end());
  std::sort(wanted.begin(), wanted.end());
  EXPECT_EQ(found, wanted);
}

TEST(FindShape, NamesWhatIsNotThere) {
  const SetFolder folder;
  folder.put_meshes({"cat0.off"});
  const ShapeSet set = set_of(folder);
  EXPECT_EQ(find_shape(set, "cat0.off").label, "cat");
  EXPECT_EQ(refusal_of(folder, ErrorKind::bad_request, [&] { (void)find_shape(set, "cat1.off"); }),
            "SET: has no shape cat1.off");
}

TEST(ShapeStem, DropsTheEndingOfAMesh) {
  EXPECT_EQ(shape_stem("cat0.off"), "cat0");
  EXPECT_EQ(shape_stem("cat0.ply.gz"), "cat0");
  EXPECT_EQ(shape_stem("cat.v1.ply"), "cat.v1");
  EXPECT_EQ(shape_stem("cat"), "cat");
  EXPECT_EQ(shape_stem(".hidden"), ".hidden");
}

class Tosca : public testing::Test {
 protected:
  SetFolder folder_;

  [[nodiscard]] MeshFile read(const std::string& vert, const std::string& tri) const {
    folder_.put("cat0.vert", vert);
    folder_.put("cat0.tri", tri);
    return read_set_mesh(folder_ / "cat0.vert");
  }

  [[nodiscard]] std::string refused_text(const std::string& vert, const std::string& tri) const {
    return refusal_of(folder_, ErrorKind::bad_input, [&] { (void)read(vert, tri); });
  }
};

constexpr char kVert[] = "0 0 0\r\n1 0 0\r\n\r\n0 1e0 0\r\n0 0 1";
constexpr char kTri[] = "1 2 3\n1 4 2\n2.0 4 3\n3 4 1\n";

TEST_F(Tosca, TextFormIsRead) {
  const MeshFile file = read(kVert, kTri);
  EXPECT_EQ(file.format, "vert");
  EXPECT_EQ(file.mesh.vertices.rows(), 4);
  EXPECT_EQ(file.mesh.vertices.row(2), Eigen::RowVector3d(0, 1, 0));
  EXPECT_EQ(file.mesh.faces.row(1), Eigen::RowVector3i(0, 3, 1));
  folder_.put("cat1.vert", kVert);
  EXPECT_EQ(labels_of(set_of(folder_)), (Names{"cat", "cat"}));
}

TEST_F(Tosca, BrokenTextFormIsRefusedWithItsLine) {
  const auto vertex = [](const std::string& v) {
    return "SET/cat0.tri: line 1: '" + v + "' is no vertex; they count from 1 to 4";
  };
  EXPECT_EQ(refused_text(kVert, "0 1 2\n"), vertex("0"));
  EXPECT_EQ(refused_text(kVert, "1 2 5\n"), vertex("5"));
  EXPECT_EQ(refused_text(kVert, "1 2.5 3\n"), vertex("2.5"));
  EXPECT_EQ(refused_text(kVert, "1 2 1e300\n"), vertex("1e300"));
  EXPECT_EQ(refused_text(kVert, "1 2\n"), "SET/cat0.tri: line 1: three numbers are wanted");
  EXPECT_EQ(refused_text("0 0 0\nx 0 0\n", kTri), "SET/cat0.vert: line 2: 'x' is not a number");
  EXPECT_EQ(refused_text("0 0 1e999\n", kTri), "SET/cat0.vert: line 1: '1e999' is not a number");
  EXPECT_EQ(refused_text("0 0 nan\n", kTri), "SET/cat0.vert: line 1: 'nan' is not a number");
  EXPECT_EQ(refused_text("0 0\n", kTri), "SET/cat0.vert: line 1: three numbers are wanted");
  EXPECT_EQ(refused_text("0 0 \0\n"s, kTri), "SET/cat0.vert: line 1: '\\x00' is not a number");
  EXPECT_EQ(refused_text("\n", kTri), "SET/cat0.vert: holds no point");
}

TEST_F(Tosca, TextFormKeepsToTheLimitAndNeedsBothFiles) {
  (void)read(kVert, kTri);
  EXPECT_EQ(refusal_of(folder_, ErrorKind::bad_input,
                       [&] { (void)read_set_mesh(folder_ / "cat0.vert", {.size_limit = 10}); }),
            "SET/cat0.vert: size: larger than the limit of 10 bytes");
  std::filesystem::remove(folder_ / "cat0.tri");
  EXPECT_EQ(refusal_of(folder_, ErrorKind::io, [&] { (void)read_set_mesh(folder_ / "cat0.vert"); }),
            "SET/cat0.tri: open: No such file or directory");
}

}  // namespace
}  // namespace timbre

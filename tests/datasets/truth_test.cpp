#include "timbre/datasets/truth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "timbre/analysis/mesh/read_mesh.h"
#include "timbre/tests/support/set_folder.h"
#include "timbre/tests/support/shared_data.h"

namespace timbre {
namespace {

using Vertices = std::vector<std::int32_t>;

constexpr std::int64_t kFour = 4;  // vertices of a tetrahedron

class TruthOfASet : public testing::Test {
 protected:
  void SetUp() override { folder_.put_meshes({"a1.off", "a2.ply.gz", "b1.off"}); }

  [[nodiscard]] ShapeSet set() const { return read_shape_set(folder_.path().string()); }

  [[nodiscard]] Truth map_of(std::int64_t sources = kFour, std::int64_t targets = kFour) const {
    const ShapeSet all = set();
    return map_truth(all, find_shape(all, "a1.off"), sources, find_shape(all, "a2.ply.gz"),
                     targets);
  }

  [[nodiscard]] Truth symmetry_of(const std::string& name = "a1.off") const {
    const ShapeSet all = set();
    return symmetry_truth(all, find_shape(all, name), kFour);
  }

  template <typename Work>
  [[nodiscard]] std::string refused(Work&& work) const {
    return refusal_of(folder_, ErrorKind::bad_input, std::forward<Work>(work));
  }

  [[nodiscard]] std::string refused_map(std::int64_t sources = kFour,
                                        std::int64_t targets = kFour) const {
    return refused([&] { (void)map_of(sources, targets); });
  }

  [[nodiscard]] std::string refused_symmetry(const std::string& name = "a1.off") const {
    return refused([&] { (void)symmetry_of(name); });
  }

  SetFolder folder_;
};

TEST_F(TruthOfASet, GoesThroughTheTemplate) {
  folder_.put("a1.vts", "1\n0\n2\n2\n-3\n4\n");
  folder_.put("a2.vts", "4\r\n3\r\n3\r\n1\r\n1\r\n0");
  const Truth truth = map_of();
  EXPECT_EQ(truth.source, (Vertices{0, 1, 1}));
  EXPECT_EQ(truth.target, (Vertices{3, 2, 0}));
  EXPECT_FALSE(truth.partial);
  EXPECT_STREQ(truth_form(set(), set().shapes[1]), "vts");
}

TEST_F(TruthOfASet, GoesFromPartToWhole) {
  folder_.put("a1.map", "3\n-1\n0\n");
  const Truth truth = map_of(3);
  EXPECT_EQ(truth.source, (Vertices{0, 2}));
  EXPECT_EQ(truth.target, (Vertices{3, 0}));
  EXPECT_TRUE(truth.partial);
  EXPECT_STREQ(truth_form(set(), set().shapes[0]), "map");
  // The whole may be the only one with a template.
  folder_.put("a2.vts", "1\n");
  EXPECT_EQ(map_of(3).target, truth.target);
}

TEST_F(TruthOfASet, TakesEqualNumbersWhereNothingElseIsSaid) {
  const Truth truth = map_of();
  EXPECT_EQ(truth.source, (Vertices{0, 1, 2, 3}));
  EXPECT_EQ(truth.target, truth.source);
  EXPECT_STREQ(truth_form(set(), set().shapes[0]), "numbers");
  EXPECT_EQ(refused_map(4, 5),
            "SET/a1.off: nothing tells where its vertices belong on a2.ply.gz: no .vts of both, no "
            ".map, and the numbers of vertices differ");
}

TEST_F(TruthOfASet, DoesNotGuessWhenOneListIsMissing) {
  folder_.put("a1.vts", "1\n2\n3\n4\n");
  EXPECT_EQ(refused_map(), "SET/a2.vts: is missing; the other shape of the pair has its own");
  std::filesystem::rename(folder_ / "a1.vts", folder_ / "a2.vts");
  EXPECT_EQ(refused_map(), "SET/a1.vts: is missing; the other shape of the pair has its own");
}

TEST_F(TruthOfASet, IsRefusedWhereListsDoNotFit) {
  folder_.put("a1.vts", "1\n2\n");
  folder_.put("a2.vts", "1\n");
  EXPECT_EQ(refused_map(), "SET/a2.vts: has 1 points and SET/a1.vts has 2: not of one template");
  folder_.put("a2.vts", "1\n5\n");
  EXPECT_EQ(refused_map(), "SET/a2.vts: line 2: 5 is no vertex; there are 4, from 1");
  folder_.put("a2.vts", "1\n2.0\n");
  EXPECT_EQ(refused_map(), "SET/a2.vts: line 2: '2.0' is no integer");
  folder_.put("a2.vts", "1\n99999999999999999999\n");
  EXPECT_EQ(refused_map(), "SET/a2.vts: line 2: '99999999999999999999' is no integer");
  folder_.put("a2.vts", "1 2\n");
  EXPECT_EQ(refused_map(), "SET/a2.vts: line 1: one vertex is wanted");
  folder_.put("a2.vts", "0\n0\n");
  EXPECT_EQ(refused_map(), "SET/a1.vts: tells nothing: no row is known on both sides");
  folder_.put("a1.vts", "");
  folder_.put("a2.vts", "");
  EXPECT_EQ(refused_map(), "SET/a1.vts: tells nothing: no row is known on both sides");
}

TEST_F(TruthOfASet, IsRefusedWhereAPartDoesNotFit) {
  folder_.put("a1.map", "0\n1\n");
  EXPECT_EQ(refused_map(3), "SET/a1.map: has 2 lines; a1.off has 3 vertices");
  folder_.put("a1.map", "0\n4\n");
  EXPECT_EQ(refused_map(2), "SET/a1.map: line 2: 4 is no vertex; there are 4, from 0");
  folder_.put("a1.map", "-1\n-1\n");
  EXPECT_EQ(refused_map(2), "SET/a1.map: tells nothing: no row is known on both sides");
}

TEST_F(TruthOfASet, ListsTakeTheSmallestIntegerForNone) {
  folder_.put("m", "-9223372036854775808\n9223372036854775807\n");
  EXPECT_EQ(refused([&] { (void)read_vertex_list(folder_ / "m", 1, kFour); }),
            "SET/m: line 2: 9223372036854775807 is no vertex; there are 4, from 1");
  folder_.put("m", "-9223372036854775808\n");
  EXPECT_EQ(read_vertex_list(folder_ / "m", 1, kFour), Vertices{-1});
}

TEST_F(TruthOfASet, SymmetryStandsInAListOfItsOwn) {
  folder_.put("a2.vts", "1\n2\n3\n0\n");
  folder_.put("a2.sym.vts", "2\n1\n0\n4\n");
  EXPECT_TRUE(has_symmetry_truth(set(), set().shapes[1]));
  const Truth truth = symmetry_of("a2.ply.gz");
  EXPECT_EQ(truth.source, (Vertices{0, 1}));
  EXPECT_EQ(truth.target, (Vertices{1, 0}));
}

TEST_F(TruthOfASet, SymmetryStandsInATableForAll) {
  folder_.put("a1.vts", "4\n2\n3\n");
  folder_.put("symmetry.txt", "all\n2\n1\n0\n");
  const Truth truth = symmetry_of();
  EXPECT_EQ(truth.source, (Vertices{3, 1}));
  EXPECT_EQ(truth.target, (Vertices{1, 3}));
  EXPECT_TRUE(has_symmetry_truth(set(), set().shapes[0]));
  EXPECT_FALSE(has_symmetry_truth(set(), set().shapes[2]));
}

TEST_F(TruthOfASet, SymmetryStandsInTheColumnOfALabel) {
  folder_.put("a1.vts", "4\n2\n");
  folder_.put("b1.vts", "1\n2\n");
  folder_.put("symmetry.txt", "c a\n0 2\n0 1\n3 0\n");
  EXPECT_EQ(symmetry_of().target, (Vertices{1, 3}));
  EXPECT_FALSE(has_symmetry_truth(set(), find_shape(set(), "b1.off")));
  folder_.put("symmetry.txt", "c a\n0 0\n0 0\n");
  EXPECT_EQ(refused_symmetry(), "SET/a1.vts: tells nothing: no row is known on both sides");
}

TEST_F(TruthOfASet, SymmetryIsRefusedWhereItDoesNotFit) {
  const std::string unknown =
      ".off: no symmetry is known: neither .vts with .sym.vts nor .vts with symmetry.txt";
  EXPECT_EQ(refused_symmetry(), "SET/a1" + unknown);
  folder_.put("a1.vts", "1\n2\n3\n");
  EXPECT_EQ(refused_symmetry(), "SET/a1" + unknown);
  folder_.put("symmetry.txt", "b c\n1 1\n");
  EXPECT_EQ(refused_symmetry(), "SET/symmetry.txt: line 1: has no column 'a' for a1.off");
  folder_.put("symmetry.txt", "a c\n1 1\n2 2\n");
  EXPECT_EQ(refused_symmetry(),
            "SET/symmetry.txt: has 2 rows; the template of a1.off has 3 points");
  folder_.put("symmetry.txt", "a c\n1 1\n2\n3 3\n");
  EXPECT_EQ(refused_symmetry(), "SET/symmetry.txt: line 3: has 1 columns, not 2");
  folder_.put("symmetry.txt", "a c\n1 1\n4 1\n3 3\n");
  EXPECT_EQ(refused_symmetry(), "SET/symmetry.txt: line 3: 4 is no vertex; there are 3, from 1");
  folder_.put("a1.sym.vts", "1\n");
  EXPECT_EQ(refused_symmetry(), "SET/a1.sym.vts: has 1 lines and SET/a1.vts has 3");
}

TEST(Mirrored, ReplacesTargetsByTheirImages) {
  const Truth truth{{0, 1, 2, 3}, {3, 2, 1, 3}, true};
  const Truth symmetry{{3, 1}, {0, 1}, false};
  const Truth image = mirrored(truth, symmetry, kFour);
  EXPECT_EQ(image.source, (Vertices{0, 2, 3}));
  EXPECT_EQ(image.target, (Vertices{0, 1, 0}));
  EXPECT_TRUE(image.partial);
}

struct PublicSet {
  const char* name;
  std::size_t shapes, pairs;
  std::size_t rows;  // of the .vts files; 0: the form is another
  const char* form;  // of the source of the first pair
  std::size_t symmetric;
};

class EveryPublicSet : public testing::TestWithParam<PublicSet> {};

TEST_P(EveryPublicSet, HasTruthForEachListedPair) {
  const PublicSet& wanted = GetParam();
  const std::string relative = std::string("correspondence/") + wanted.name;
  TIMBRE_NEEDS_SHARED_DATA(relative);
  const ShapeSet set = read_shape_set((shared_data() / relative).string());
  EXPECT_EQ(set.shapes.size(), wanted.shapes);
  EXPECT_EQ(set.pairs.size(), wanted.pairs);
  EXPECT_TRUE(set.pairs_listed);
  EXPECT_STREQ(truth_form(set, find_shape(set, set.pairs[0].first)), wanted.form);
  std::map<std::string, std::int64_t> vertices;
  for (const SetShape& shape : set.shapes) {
    vertices[shape.name] = read_set_mesh(shape.file).mesh.vertices.rows();
  }
  for (const auto& [source, target] : set.pairs) {
    const Truth truth = map_truth(set, find_shape(set, source), vertices[source],
                                  find_shape(set, target), vertices[target]);
    EXPECT_EQ(truth.partial, std::string(wanted.form) == "map");
    EXPECT_EQ(truth.source.size(),
              wanted.rows > 0 ? wanted.rows : static_cast<std::size_t>(vertices[source]))
        << source << " " << target;
  }
  std::size_t symmetric = 0;
  for (const SetShape& shape : set.shapes) {
    if (!has_symmetry_truth(set, shape)) continue;
    ++symmetric;
    EXPECT_GT(symmetry_truth(set, shape, vertices[shape.name]).source.size(), 400U) << shape.name;
  }
  EXPECT_EQ(symmetric, wanted.symmetric);
}

INSTANTIATE_TEST_SUITE_P(Sets, EveryPublicSet,
                         testing::Values(PublicSet{"faust_r", 100, 100, 5000, "vts", 100},
                                         PublicSet{"faust_a", 10, 60, 6890, "vts", 0},
                                         PublicSet{"scape", 10, 60, 0, "numbers", 0},
                                         PublicSet{"scape_a", 10, 60, 12500, "vts", 0},
                                         PublicSet{"shrec19", 13, 60, 6890, "vts", 0},
                                         PublicSet{"tosca_noniso_r", 24, 60, 900, "vts", 24},
                                         PublicSet{"smal_r", 25, 80, 3889, "vts", 0},
                                         PublicSet{"partial_shrec16_cuts", 20, 16, 0, "map", 0},
                                         PublicSet{"partial_pfarm", 19, 18, 0, "map", 0}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(PublicSets, ToscaHasFewerRowsForTheWolf) {
  TIMBRE_NEEDS_SHARED_DATA("correspondence/tosca_r");
  const ShapeSet set = read_shape_set((shared_data() / "correspondence/tosca_r").string());
  EXPECT_EQ(set.shapes.size(), 76U);
  EXPECT_EQ(set.pairs.size(), 104U);
  std::map<std::string, std::int64_t> vertices;
  for (const SetShape& shape : set.shapes) {
    vertices[shape.name] = read_set_mesh(shape.file).mesh.vertices.rows();
    EXPECT_TRUE(has_symmetry_truth(set, shape)) << shape.name;
    EXPECT_GT(symmetry_truth(set, shape, vertices[shape.name]).source.size(), 2500U) << shape.name;
  }
  for (const auto& [source, target] : set.pairs) {
    const SetShape& a = find_shape(set, source);
    EXPECT_EQ(a.label, find_shape(set, target).label);
    EXPECT_EQ(map_truth(set, a, vertices[source], find_shape(set, target), vertices[target])
                  .source.size(),
              a.label == "wolf" ? 4344U : 5000U)
        << source << " " << target;
  }
}

TEST(PublicSets, RetrievalHasNineOfEachOfSixteenClasses) {
  TIMBRE_NEEDS_SHARED_DATA("retrieval/shrec07");
  const ShapeSet set = read_shape_set((shared_data() / "retrieval/shrec07").string());
  std::map<std::string, int> classes;
  for (const SetShape& shape : set.shapes) ++classes[shape.label];
  EXPECT_EQ(set.shapes.size(), 144U);
  EXPECT_EQ(classes.size(), 16U);
  for (const auto& [label, count] : classes) EXPECT_EQ(count, 9) << label;
}

}  // namespace
}  // namespace timbre

#include "timbre/index/nearest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "timbre/tests/support/temporary_folder.h"

namespace timbre {
namespace {

// Clusters of vectors; every hundredth is shorter when `some_short`.
Gallery clustered(int count, int dimension, unsigned seed, bool some_short = false) {
  Gallery gallery(find_channel("dna_weyl"));
  std::mt19937 draw(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd centres(dimension, 50);
  for (double& x : centres.reshaped()) x = normal(draw);
  for (int i = 0; i < count; ++i) {
    Eigen::VectorXd vector = centres.col(i % 50);
    for (double& x : vector) x += 0.2 * normal(draw);
    if (some_short && i % 100 == 7) vector.conservativeResize(dimension / 2);
    ShapeInfo shape;
    shape.name = std::to_string(i);
    gallery.add(shape, vector);
  }
  return gallery;
}

std::vector<std::int64_t> sorted(std::vector<std::int64_t> found) {
  std::sort(found.begin(), found.end());
  return found;
}

TEST(NearestIndex, FindsNearlyAllOfTheTrueFirstTen) {
  const Gallery gallery = clustered(20000, 16, 1);
  const NearestIndex index(gallery);
  EXPECT_GT(index.recall(), 0.99);
  const auto found = index.candidates(gallery.vector(5), 500);
  EXPECT_EQ(found.size(), 500U);
  EXPECT_EQ(rank_candidates(gallery, gallery.vector(5), found, 1)[0].index, 5);
}

TEST(NearestIndex, IsTheSameInEveryBuildAndAfterLoading) {
  const Gallery gallery = clustered(5000, 16, 2, true);
  const NearestIndex one(gallery);
  const NearestIndex two(gallery);
  const auto loaded = NearestIndex::from_bytes(gallery, one.to_bytes());
  ASSERT_TRUE(loaded.has_value());
  EXPECT_EQ(loaded->recall(), one.recall());
  for (std::int64_t q = 0; q < 300; ++q) {
    const auto expected = one.candidates(gallery.vector(q), 50);
    EXPECT_EQ(two.candidates(gallery.vector(q), 50), expected);
    EXPECT_EQ(loaded->candidates(gallery.vector(q), 50), expected);
  }
}

TEST(NearestIndex, AlwaysOffersShapesWithShortVectors) {
  const Gallery gallery = clustered(1000, 8, 3, true);
  const auto found = sorted(NearestIndex(gallery).candidates(gallery.vector(0), 20));
  for (std::int64_t i = 7; i < 1000; i += 100) {
    EXPECT_TRUE(std::binary_search(found.begin(), found.end(), i)) << i;
  }
  // A query that is short itself is compared with all.
  EXPECT_EQ(NearestIndex(gallery).candidates(gallery.vector(7), 20).size(), 1000U);
}

TEST(NearestIndex, WorksWithFewOrNoVectors) {
  const Gallery none(find_channel("dna_weyl"));
  EXPECT_TRUE(NearestIndex(none).candidates(std::vector<double>{1.0}, 5).empty());
  EXPECT_EQ(NearestIndex(none).recall(), 1.0);
  const Gallery three = clustered(3, 4, 4);
  const NearestIndex index(three);
  EXPECT_EQ(sorted(index.candidates(three.vector(1), 2)).size(), 2U);
  EXPECT_EQ(sorted(index.candidates(three.vector(1), 10)), (std::vector<std::int64_t>{0, 1, 2}));
  EXPECT_TRUE(NearestIndex::from_bytes(none, NearestIndex(none).to_bytes()).has_value());
}

TEST(NearestIndex, RefusesBytesThatAreDamagedOrOfOtherVectors) {
  const Gallery gallery = clustered(2000, 8, 5);
  const std::string bytes = NearestIndex(gallery).to_bytes();
  std::mt19937 draw(6);
  std::uniform_int_distribution<std::size_t> place(0, bytes.size() - 1);
  for (int round = 0; round < 60; ++round) {
    std::string damaged = bytes;
    const std::size_t at = place(draw);
    if (round % 6 == 0) {
      damaged.resize(at);
    } else {
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << round % 8));
    }
    EXPECT_FALSE(NearestIndex::from_bytes(gallery, damaged).has_value()) << at;
  }
  EXPECT_FALSE(NearestIndex::from_bytes(gallery, "").has_value());
  EXPECT_FALSE(NearestIndex::from_bytes(clustered(2001, 8, 5), bytes).has_value());
  EXPECT_FALSE(NearestIndex::from_bytes(clustered(2000, 8, 6), bytes).has_value());
}

TEST(OpenNearest, RebuildsAnOldOrDamagedFileWithOneNoteAndTheSameAnswers) {
  const TemporaryFolder folder;
  const std::string path = folder / "db.dna_weyl.index";
  const Gallery gallery = clustered(1000, 8, 7);
  int notes = 0;
  const auto note = [&](const std::string&) { ++notes; };
  const auto expected = open_nearest(gallery, path, note).candidates(gallery.vector(3), 30);
  EXPECT_EQ(notes, 0);
  const std::string bytes = file_content(path);
  EXPECT_EQ(open_nearest(gallery, path, note).candidates(gallery.vector(3), 30), expected);
  EXPECT_EQ(notes, 0);
  std::string damaged = bytes;
  damaged[damaged.size() / 2] ^= 1;
  put_file(path, damaged);
  EXPECT_EQ(open_nearest(gallery, path, note).candidates(gallery.vector(3), 30), expected);
  EXPECT_EQ(notes, 1);
  EXPECT_TRUE(NearestIndex::from_bytes(gallery, file_content(path)).has_value());
  (void)open_nearest(clustered(1001, 8, 7), path, note);
  EXPECT_EQ(notes, 2);
  (void)open_nearest(gallery, folder / "no/such/place", note);
  EXPECT_EQ(notes, 3);
}

}  // namespace
}  // namespace timbre

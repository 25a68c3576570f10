#include "timbre/index/query.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "timbre/analysis/core/error.h"
#include "timbre/datasets/analytic.h"
#include "timbre/index/features.h"
#include "timbre/tests/support/sample_records.h"
#include "timbre/tests/support/temporary_folder.h"

namespace timbre {
namespace {

Store filled(const std::string& path, unsigned count) {
  Store store = Store::create(path);
  for (unsigned i = 0; i < count; ++i) {
    (void)store.add(sample_record("s" + std::to_string(i), i, 20, i % 3 == 0 ? "third" : ""));
  }
  return store;
}

// By hand, through the store's plainest calls.
std::vector<std::pair<double, std::string>> brute_force(const Store& store, const std::string& name,
                                                        const Channel& channel) {
  const Eigen::VectorXd query = store.descriptor(name, channel);
  std::vector<std::pair<double, std::string>> ranking;
  for (const ShapeInfo& shape : store.list()) {
    if (shape.name == name) continue;
    const Eigen::VectorXd other = store.descriptor(shape.name, channel);
    ranking.emplace_back(
        channel.name == "dna_i" ? (query - other).norm() : (query - other).cwiseAbs().mean(),
        shape.name);
  }
  std::stable_sort(ranking.begin(), ranking.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  return ranking;
}

TEST(QueryStored, EqualsBruteForceInEveryChannel) {
  const TemporaryFolder folder;
  const Store store = filled(folder / "db", 40);
  for (const Channel& channel : channels()) {
    const auto expected = brute_force(store, "s5", channel);
    const QueryAnswer answer = query_stored(store, "s5", {.channel = channel.name, .count = 0});
    ASSERT_EQ(answer.results.size(), 39U);
    for (std::size_t i = 0; i < 39; ++i) {
      const QueryResult& result = answer.results[i];
      EXPECT_EQ(result.rank, static_cast<int>(i) + 1);
      EXPECT_EQ(result.name, expected[i].second);
      EXPECT_NEAR(result.distance, expected[i].first, 1e-14);
      EXPECT_FALSE(result.score.has_value());
      ASSERT_EQ(result.channels.size(), 1U);
      EXPECT_EQ(result.channels[0].first, channel.name);
    }
  }
}

TEST(QueryStored, GivesTheSameByWayOfTheIndex) {
  const TemporaryFolder folder;
  Store store = filled(folder / "db", 700);
  int notes = 0;
  const QueryOptions by_index = {
      .count = 10, .exact_below = 1, .note = [&](const std::string&) { ++notes; }};
  const auto names = [](const QueryAnswer& answer) {
    std::string text;
    for (const QueryResult& result : answer.results) text += result.name + " ";
    return text;
  };
  const QueryAnswer exact = query_stored(store, "s9");
  const QueryAnswer found = query_stored(store, "s9", by_index);
  EXPECT_EQ(exact.compared, 699);
  EXPECT_LT(found.compared, 699);
  EXPECT_EQ(names(found), names(exact));
  // A twin of s9 is the nearest as soon as it is stored.
  (void)store.add(sample_record("twin", 9, 20));
  EXPECT_EQ(names(query_stored(store, "s9", by_index)).substr(0, 5), "twin ");
  EXPECT_EQ(notes, 1);
  put_file(folder / "db.dna_weyl.index", "damaged");
  EXPECT_EQ(names(query_stored(store, "s9", by_index)).substr(0, 5), "twin ");
  EXPECT_EQ(notes, 2);
}

TEST(QueryStored, BreaksTiesByTheOrderOfAdding) {
  const TemporaryFolder folder;
  Store store = Store::create(folder / "db");
  for (const char* const name : {"z", "m", "a", "q"}) (void)store.add(sample_record(name, 1));
  const QueryAnswer answer = query_stored(store, "m");
  ASSERT_EQ(answer.results.size(), 3U);
  EXPECT_EQ(answer.results[0].name, "z");
  EXPECT_EQ(answer.results[1].name, "a");
  EXPECT_EQ(answer.results[2].name, "q");
}

TEST(QueryMesh, FindsTheSameMeshAtDistanceZero) {
  const TemporaryFolder folder;
  const StoreParameters parameters = {.count = 30};
  Store store = Store::create(folder / "db", parameters);
  const TriangleMesh egg = make_ellipsoid(1.0, 0.8, 0.6, 4);
  (void)store.add(compute_record("ball", "round", make_sphere(4), parameters));
  (void)store.add(compute_record("egg", "", egg, parameters));
  TriangleMesh larger = egg;
  larger.vertices *= 4.0;
  for (const Channel& channel : channels()) {
    const QueryAnswer same = query_mesh(store, egg, {.channel = channel.name});
    ASSERT_EQ(same.results.size(), 2U);
    EXPECT_EQ(same.results[0].name, "egg");
    EXPECT_EQ(same.results[0].distance, 0.0);
    EXPECT_EQ(same.results[1].label, "round");
    const double distance =
        query_mesh(store, larger, {.channel = channel.name}).results[0].distance;
    EXPECT_TRUE(distance < 1e-9 || channel.name == "dna_raw") << channel.name << distance;
  }
}

TEST(QueryStored, RefusesUnknownNamesAndChannels) {
  const TemporaryFolder folder;
  const Store store = filled(folder / "db", 2);
  for (const auto& call : {std::pair("nobody", "dna_log"), std::pair("s1", "dna")}) {
    try {
      (void)query_stored(store, call.first, {.channel = call.second});
      FAIL() << "no exception";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_request);
    }
  }
}

}  // namespace
}  // namespace timbre

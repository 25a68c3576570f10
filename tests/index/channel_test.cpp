#include "timbre/index/channel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "timbre/analysis/core/error.h"
#include "timbre/datasets/analytic.h"
#include "timbre/index/features.h"

namespace timbre {
namespace {

TEST(Channels, HaveDifferentNamesAndAreAllThere) {
  std::set<std::string> names;
  for (const Channel& channel : channels()) names.insert(channel.name);
  EXPECT_EQ(names, (std::set<std::string>{"dna_i", "dna_log", "dna_raw", "dna_wesd", "dna_weyl",
                                          "gps_q"}));
  EXPECT_EQ(channels().size(), names.size());
  EXPECT_EQ(find_channel(kDefaultChannel).name, "dna_weyl");
}

TEST(FindChannel, NamesWhatThereIs) {
  try {
    (void)find_channel("dna");
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_request);
    EXPECT_STREQ(error.what(),
                 "channel: there is no 'dna'; there are dna_i, dna_log, dna_raw, dna_weyl, "
                 "dna_wesd, gps_q");
  }
}

TEST(CanonicalText, SortsKeys) {
  EXPECT_EQ(canonical_text({{"k", "200"}, {"a", "1"}}), "a=1 k=200");
  EXPECT_EQ(canonical_text({}), "");
}

TEST(Distances, CompareTheLeadingEntriesBothHave) {
  const std::vector<double> a = {1, 2, 3};
  const std::vector<double> b = {2, 4};
  EXPECT_EQ(mean_absolute_difference(a, b), 1.5);
  EXPECT_DOUBLE_EQ(euclidean_distance(b, a), std::sqrt(5.0));
  constexpr double kInf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(mean_absolute_difference({}, a), kInf);
  EXPECT_EQ(euclidean_distance(a, {}), kInf);
}

TEST(Channels, DoNotSeeScaleExceptTheRawOne) {
  TriangleMesh mesh = make_ellipsoid(1.0, 0.8, 0.5, 5);
  const StoreParameters parameters = {.count = 40};
  const ShapeFeatures one = compute_features(mesh, parameters);
  mesh.vertices *= 8.0;
  const ShapeFeatures eight = compute_features(mesh, parameters);
  for (const Channel& channel : channels()) {
    const Eigen::VectorXd difference = channel.compute(eight) - channel.compute(one);
    const double expected = channel.name == "dna_raw" ? -std::log(64.0) : 0.0;
    EXPECT_LT((difference.array() - expected).abs().maxCoeff(), 1e-6) << channel.name;
  }
}

TEST(Channels, DescribeASmallMeshByLess) {
  const ShapeRecord record =
      compute_record("small", "", make_sphere(2), {.count = 200});  // 42 vertices
  for (const Descriptor& descriptor : record.descriptors) {
    const Eigen::Index expected = descriptor.channel == "gps_q"   ? 64
                                  : descriptor.channel == "dna_i" ? 30
                                                                  : 41;
    EXPECT_EQ(descriptor.values.size(), expected) << descriptor.channel;
    EXPECT_TRUE(descriptor.values.allFinite()) << descriptor.channel;
  }
  EXPECT_EQ(record.eigenvalues.size(), 42);
}

TEST(Channels, DescribeAMeshOfMoreComponentsThanEigenvalues) {
  TriangleMesh crumbs;
  crumbs.vertices.resize(30, 3);
  crumbs.faces.resize(10, 3);
  for (std::int32_t i = 0; i < 10; ++i) {
    crumbs.vertices.middleRows(3 * i, 3) << i, 0, 0, i + 0.5, 0, 0, i, 0.5, 0;
    crumbs.faces.row(i) << 3 * i, 3 * i + 1, 3 * i + 2;
  }
  for (const Descriptor& descriptor : compute_record("c", "", crumbs, {.count = 5}).descriptors) {
    EXPECT_EQ(descriptor.values.size(), descriptor.channel == "gps_q" ? 0 : 4);
    EXPECT_TRUE(descriptor.values.allFinite());
  }
}

}  // namespace
}  // namespace timbre

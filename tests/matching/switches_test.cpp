#include "timbre/matching/switches.h"

#include <gtest/gtest.h>

namespace timbre {
namespace {

TEST(FindSwitches, ListsOnlyWhatDiffersFromTheIdentity) {
  EXPECT_TRUE(find_switches(Eigen::MatrixXd::Identity(8, 8), 8).empty());
}

TEST(FindSwitches, NamesFlipsExchangesAndMixtures) {
  Eigen::MatrixXd C = Eigen::MatrixXd::Identity(7, 7);
  C(1, 1) = -1.0;
  C.block(2, 2, 2, 2) << 0, 1, -1, 0;
  C.block(4, 4, 2, 2) << 0.6, 0.69, -0.69, 0.6;
  const std::vector<Switch> found = find_switches(C, 7);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[0].kind, SwitchKind::flipped);
  EXPECT_EQ(found[0].source, std::vector<int>{1});
  EXPECT_EQ(found[1].kind, SwitchKind::exchanged);
  EXPECT_EQ(found[1].target, std::vector<int>{3});
  EXPECT_EQ(found[2].target, std::vector<int>{2});
  EXPECT_EQ(found[3].kind, SwitchKind::mixed);
  EXPECT_EQ(found[3].source, (std::vector<int>{4, 5}));
  EXPECT_EQ(found[3].target, (std::vector<int>{4, 5}));
}

TEST(FindSwitches, SaysWhenAFunctionHasNoCounterpart) {
  Eigen::MatrixXd C = Eigen::MatrixXd::Identity(4, 4);
  C(2, 2) = 0.1;
  const std::vector<Switch> found = find_switches(C, 4);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, SwitchKind::mixed);
  EXPECT_TRUE(found[0].target.empty());
}

}  // namespace
}  // namespace timbre

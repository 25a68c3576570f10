#include "timbre/cli/render/colour_map.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace timbre::cli {
namespace {

// How people without green or red cones see linear light (Vienot, Brettel and Mollon 1999).
const std::array<Eigen::Matrix3f, 3>& eyes() {
  static const std::array<Eigen::Matrix3f, 3> kEyes = [] {
    std::array<Eigen::Matrix3f, 3> all;
    all[0].setIdentity();
    all[1] << 0.29275F, 0.70725F, 0.0F, 0.29275F, 0.70725F, 0.0F, -0.02234F, 0.02234F, 1.0F;
    all[2] << 0.11238F, 0.88762F, 0.0F, 0.11238F, 0.88762F, 0.0F, 0.00401F, -0.00401F, 1.0F;
    return all;
  }();
  return kEyes;
}

double distance(const Colour& a, const Colour& b, const Eigen::Matrix3f& eye) {
  const auto seen = [&](const Colour& colour) {
    return to_oklab(to_srgb((eye * to_linear(colour)).cwiseMax(0.0F).cwiseMin(1.0F)));
  };
  return (seen(a) - seen(b)).norm();
}

TEST(ColourSpace, GoesThereAndBack) {
  for (const float v : {0.0F, 0.02F, 0.3F, 1.0F}) {
    EXPECT_NEAR(to_srgb(to_linear(Colour::Constant(v)))(0), v, 1e-5F);
  }
  EXPECT_NEAR(lightness_of(Colour::Ones()), 100.0, 1e-3);
  EXPECT_NEAR(lightness_of(Colour::Constant(0.4663266F)), 50.0, 0.01);
  EXPECT_NEAR((to_oklab(Colour::Ones()) - Eigen::Vector3d::UnitX()).norm(), 0.0, 1e-6);
}

TEST(ColourSpace, KeepsLightnessWhereTheScreenLacksChroma) {
  for (int hue = 0; hue < 360; hue += 30) {
    for (const double lightness : {5.0, 30.0, 60.0, 90.0}) {
      const Colour colour = colour_of(lightness, 0.4, hue);
      EXPECT_NEAR(lightness_of(colour), lightness, 0.1);
      EXPECT_GE(colour.minCoeff(), 0.0F);
      EXPECT_LE(colour.maxCoeff(), 1.0F);
    }
  }
}

TEST(SequentialColours, GetLighterEvenly) {
  const ColourTable table = make_colour_table(ColourMapKind::sequential);
  const double step = (lightness_of(table.back()) - lightness_of(table.front())) /
                      static_cast<double>(table.size() - 1);
  EXPECT_GT(step, 0.2);
  for (std::size_t i = 1; i < table.size(); ++i) {
    EXPECT_NEAR(lightness_of(table[i]) - lightness_of(table[i - 1]), step, 0.02);
  }
}

TEST(DivergingColours, AreAsLightOnBothSidesAndNeutralInTheMiddle) {
  const ColourTable table = make_colour_table(ColourMapKind::diverging);
  for (std::size_t i = 0; i < table.size() / 2; ++i) {
    EXPECT_NEAR(lightness_of(table[i]), lightness_of(table[table.size() - 1 - i]), 0.05);
    EXPECT_LT(lightness_of(table[i]), lightness_of(table[i + 1]));
  }
  const Colour& middle = table[table.size() / 2];
  EXPECT_NEAR(middle.minCoeff(), middle.maxCoeff(), 0.01F);
}

// Neither map has a step that some eyes see as a jump, or as nothing.
TEST(ContinuousColours, StayApartForAllEyes) {
  for (const Eigen::Matrix3f& eye : eyes()) {
    for (const ColourMapKind kind : {ColourMapKind::sequential, ColourMapKind::diverging}) {
      const ColourTable table = make_colour_table(kind);
      EXPECT_GT(distance(table.front(), table.back(), eye), 0.25);
      for (std::size_t i = 16; i < table.size(); i += 16) {
        EXPECT_GT(distance(table[i], table[i - 16], eye), 0.02) << i;
        EXPECT_LT(distance(table[i], table[i - 16], eye), 0.12) << i;
      }
    }
  }
}

TEST(CategoricalColours, DifferPairByPairForAllEyes) {
  const ColourTable table = make_colour_table(ColourMapKind::categorical);
  for (const Eigen::Matrix3f& eye : eyes()) {
    for (std::size_t i = 0; i < table.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GT(distance(table[i], table[j], eye), 0.1) << i << " " << j << "\n" << eye;
      }
    }
  }
}

TEST(ScaleToTable, PutsZeroInTheMiddleOfDivergingColours) {
  const ColourScale scale =
      scale_to_table(Eigen::Vector3d(-1.0, 0.0, 4.0), ColourMapKind::diverging);
  EXPECT_EQ(scale.places, Eigen::Vector3d(0.375, 0.5, 1.0));
  EXPECT_EQ(scale.low, -4.0);
  EXPECT_EQ(scale.high, 4.0);
}

TEST(ScaleToTable, CutsTheEndsOnRequest) {
  Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(101, 0.0, 100.0);
  values(100) = 1e6;
  const ColourScale scale = scale_to_table(values, ColourMapKind::sequential, 10.0);
  EXPECT_EQ(scale.low, 10.0);
  EXPECT_EQ(scale.high, 90.0);
  EXPECT_EQ(scale.places(100), 1.0);
  EXPECT_EQ(scale.places(50), 0.5);
}

TEST(ScaleToTable, HoldsExtremeConstantAndMissingValues) {
  constexpr double kMost = std::numeric_limits<double>::max();
  EXPECT_EQ(scale_to_table(Eigen::Vector3d(-kMost, 0.0, kMost), ColourMapKind::sequential).places,
            Eigen::Vector3d(0.0, 0.5, 1.0));
  EXPECT_EQ(scale_to_table(Eigen::Vector2d(7.0, 7.0), ColourMapKind::sequential).places,
            Eigen::Vector2d(0.5, 0.5));
  EXPECT_EQ(scale_to_table(Eigen::Vector2d(0.0, 0.0), ColourMapKind::diverging).places,
            Eigen::Vector2d(0.5, 0.5));
  const double none = std::numeric_limits<double>::quiet_NaN();
  const ColourScale scale =
      scale_to_table(Eigen::Vector3d(none, 1.0, 3.0), ColourMapKind::sequential);
  EXPECT_TRUE(std::isnan(scale.places(0)));
  EXPECT_EQ(scale.places(2), 1.0);
}

TEST(ScaleToTable, RepeatsCategories) {
  const auto last = static_cast<double>(make_colour_table(ColourMapKind::categorical).size());
  const ColourScale scale =
      scale_to_table(Eigen::Vector4d(0.0, 1.0, last, last - 1.0), ColourMapKind::categorical);
  EXPECT_EQ(scale.places(0), scale.places(2));
  EXPECT_EQ(scale.places(3), 1.0);
}

TEST(SuggestColourMap, LooksAtSigns) {
  EXPECT_EQ(suggest_colour_map(Eigen::Vector2d(-1.0, 2.0)), ColourMapKind::diverging);
  EXPECT_EQ(suggest_colour_map(Eigen::Vector2d(0.0, 2.0)), ColourMapKind::sequential);
}

}  // namespace
}  // namespace timbre::cli

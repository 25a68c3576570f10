#include "timbre/cli/render/render.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb/stb_image.h>

#include "timbre/analysis/core/error.h"
#include "timbre/cli/render/transfer.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/mesh_shapes.h"

namespace timbre::cli {
namespace {

constexpr View kFront{};
const RenderOptions kSmall{.width = 96, .height = 96};

Image draw(const TriangleMesh& mesh, const View& view = kFront,
           const RenderOptions& options = kSmall) {
  return render({.mesh = mesh}, {view}, options).front();
}

std::array<int, 4> pixel(const Image& image, int x, int y) {
  const std::size_t i = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                             static_cast<std::size_t>(x));
  return {image.rgba[i], image.rgba[i + 1], image.rgba[i + 2], image.rgba[i + 3]};
}

double covered(const Image& image) {
  double sum = 0.0;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) sum += image.rgba[i] / 255.0;
  return sum;
}

// The share of pixels that differ by more than `step` in a channel.
double share_that_differs(const Image& a, const Image& b, int step) {
  int count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    bool differs = false;
    for (std::size_t c = 0; c < 4; ++c) {
      differs = differs || std::abs(int{a.rgba[i + c]} - int{b.rgba[i + c]}) > step;
    }
    count += differs ? 1 : 0;
  }
  return 4.0 * count / static_cast<double>(a.rgba.size());
}

std::string complaint(const SurfaceLook& look) {
  try {
    (void)render(look, {kFront}, kSmall);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

TEST(Render, SphereCoversTheDiskThatGeometrySays) {
  // Of a disk that fills 94 % of the picture's side.
  const Image image = draw(make_sphere(24), kFront, {.width = 200, .height = 200});
  const double radius = 0.5 * 0.94 * 200.0;
  EXPECT_NEAR(covered(image) / (std::numbers::pi * radius * radius), 1.0, 0.01);
  // Whatever side looks at it, and in a picture of any form.
  const Image wide = draw(make_sphere(24), {70.0, -40.0}, {.width = 300, .height = 200});
  EXPECT_NEAR(covered(wide) / covered(image), 1.0, 0.01);
}

TEST(Render, IsOpaqueInsideAndTransparentOutside) {
  const Image image = draw(make_sphere(8));
  EXPECT_EQ(pixel(image, 0, 0)[3], 0);
  EXPECT_EQ(pixel(image, 95, 95)[3], 0);
  EXPECT_EQ(pixel(image, 48, 48)[3], 255);
  const Image red = draw(make_sphere(8), kFront,
                         {.width = 96, .height = 96, .background = Colour(1.0F, 0.0F, 0.0F)});
  EXPECT_EQ(pixel(red, 0, 0), (std::array<int, 4>{255, 0, 0, 255}));
  EXPECT_EQ(pixel(red, 48, 48), pixel(image, 48, 48));
}

TEST(Render, SeesAMirroredShapeMirrored) {
  TriangleMesh mesh = make_ellipsoid(1.0, 0.5, 0.7, 8);
  mesh.vertices.col(1) += 0.3 * mesh.vertices.col(0);
  const Image image = draw(mesh);
  mesh.vertices.col(0) *= -1.0;
  const Image mirrored = draw(mesh);
  double off = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      off += std::abs(pixel(image, x, y)[3] - pixel(mirrored, image.width - 1 - x, y)[3]) / 255.0;
    }
  }
  EXPECT_LT(off, 0.01 * covered(image));
}

TEST(Render, DoesNotDependOnThreads) {
  const TriangleMesh mesh = make_torus(1.0, 0.4, 40, 16);
  RenderOptions options = kSmall;
  options.threads = 1;
  const Image one = draw(mesh, {30.0, 20.0}, options);
  options.threads = 3;
  EXPECT_EQ(draw(mesh, {30.0, 20.0}, options).rgba, one.rgba);
}

class ScaledBy : public testing::TestWithParam<double> {};

TEST_P(ScaledBy, LooksTheSame) {
  TriangleMesh mesh = make_torus(1.0, 0.4, 40, 16);
  const Image image = draw(mesh, {30.0, 40.0});
  mesh.vertices *= GetParam();
  mesh.vertices.rowwise() += GetParam() * Eigen::RowVector3d(3.0, -100.0, 7.0);
  EXPECT_LT(share_that_differs(draw(mesh, {30.0, 40.0}), image, 8), 0.005);
}
INSTANTIATE_TEST_SUITE_P(Scales, ScaledBy, testing::Values(1e-300, 1e-20, 1.0, 1e20, 1e300));

TEST(Render, PassesOverTrianglesWithoutArea) {
  TriangleMesh mesh = make_sphere(6);
  const Image image = draw(mesh);
  const Eigen::Index m = mesh.faces.rows();
  mesh.faces.conservativeResize(m + 2, 3);
  mesh.faces.row(m) << 3, 3, 5;
  mesh.faces.row(m + 1) << 7, 7, 7;
  EXPECT_EQ(draw(mesh).rgba, image.rgba);
}

TEST(Render, TakesVerticesAtOnePlaceForOne) {
  const TriangleMesh mesh = make_sphere(4);
  TriangleMesh soup{Points(3 * mesh.faces.rows(), 3), Faces(mesh.faces.rows(), 3)};
  for (Eigen::Index i = 0; i < soup.vertices.rows(); ++i) {
    // Every triangle turned inward.
    const Eigen::Index c = 2 - i % 3;
    soup.vertices.row(i) = mesh.vertices.row(mesh.faces(i / 3, c));
    soup.faces(i / 3, i % 3) = static_cast<std::int32_t>(i);
  }
  EXPECT_LT(share_that_differs(draw(soup), draw(mesh), 2), 0.01);
}

TEST(Render, ShowsTrianglesThatAreThereBothWaysRoundAlikeFromBothSides) {
  TriangleMesh mesh = grid(4);
  const Eigen::Index m = mesh.faces.rows();
  const std::array<int, 4> front = pixel(draw(mesh), 48, 48);
  mesh.faces.conservativeResize(2 * m, 3);
  mesh.faces.bottomRows(m) = mesh.faces.topRows(m).rowwise().reverse();
  EXPECT_EQ(pixel(draw(mesh), 48, 48), front);
  const std::array<int, 4> back = pixel(draw(mesh, {180.0, 0.0}), 48, 48);
  EXPECT_NEAR(back[0], front[0], 3);
}

TEST(Render, DrawsASingleTriangleFromBothSides) {
  const TriangleMesh mesh = make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  const Image front = draw(mesh);
  const Image back = draw(mesh, {180.0, 0.0});
  EXPECT_NEAR(covered(front), 0.5 * std::pow(0.94 * 96.0, 2), 60.0);
  EXPECT_NEAR(covered(back), covered(front), 20.0);
  EXPECT_EQ(pixel(front, 20, 70)[3], 255);
}

TEST(Render, ShowsTheInsideDarkerAndCooler) {
  const std::array<int, 4> outside = pixel(draw(grid(4)), 48, 48);
  const std::array<int, 4> inside = pixel(draw(grid(4), {180.0, 0.0}), 48, 48);
  EXPECT_LT(inside[0], outside[0] - 20);
  EXPECT_GT(inside[2] - inside[0], outside[2] - outside[0]);
}

TEST(Render, KeepsAFlatSideOfABoxEvenAndItsEdgesSharp) {
  const TriangleMesh box = make_mesh({{-1, -1, -1},
                                      {1, -1, -1},
                                      {1, 1, -1},
                                      {-1, 1, -1},
                                      {-1, -1, 1},
                                      {1, -1, 1},
                                      {1, 1, 1},
                                      {-1, 1, 1}},
                                     {{0, 2, 1},
                                      {0, 3, 2},
                                      {4, 5, 6},
                                      {4, 6, 7},
                                      {0, 1, 5},
                                      {0, 5, 4},
                                      {1, 2, 6},
                                      {1, 6, 5},
                                      {2, 3, 7},
                                      {2, 7, 6},
                                      {3, 0, 4},
                                      {3, 4, 7}});
  const Image image = draw(box);
  const int middle = pixel(image, 48, 48)[0];
  for (int x = 12; x < 85; x += 8) {
    for (int y = 12; y < 85; y += 8) EXPECT_NEAR(pixel(image, x, y)[0], middle, 12);
  }
}

TEST(Render, DrawsLinesOfTheSameWidthAtEveryScaleOfTheValues) {
  const TriangleMesh mesh = grid(8);
  for (const double steepness : {1e-200, 1.0, 1e200}) {
    SurfaceLook look{.mesh = mesh};
    look.lines = Isolines{steepness * (mesh.vertices.col(0).array() - 0.33).matrix(), {0.0}};
    const Image image = render(look, {kFront}, kSmall).front();
    int dark = 0;
    for (int x = 10; x < 86; ++x) dark += pixel(image, x, 48)[0] < 120 ? 1 : 0;
    EXPECT_GE(dark, 1);
    EXPECT_LE(dark, 3);
  }
}

TEST(Render, DrawsWhatHasNoColourGrey) {
  const TriangleMesh mesh = grid(4);
  const Eigen::VectorXd none =
      Eigen::VectorXd::Constant(mesh.vertices.rows(), std::numeric_limits<double>::quiet_NaN());
  SurfaceLook look{.mesh = mesh};
  look.field = ColourField{none, make_colour_table(ColourMapKind::sequential)};
  look.lines = Isolines{none, {0.0}};
  const std::array<int, 4> grey = pixel(render(look, {kFront}, kSmall).front(), 48, 48);
  EXPECT_NEAR(grey[0], grey[1], 8);
  EXPECT_NEAR(grey[1], grey[2], 8);
}

TEST(Render, PutsMarkersOnVertices) {
  const TriangleMesh mesh = grid(8);
  SurfaceLook look{.mesh = mesh};
  look.markers = {{40, Colour(0.9F, 0.1F, 0.1F)}};  // the middle of 9 x 9
  const Image image = render(look, {kFront}, kSmall).front();
  EXPECT_GT(pixel(image, 48, 48)[0], 2 * pixel(image, 48, 48)[2]);
  EXPECT_LT(pixel(image, 20, 20)[0], 2 * pixel(image, 20, 20)[2]);
}

TEST(Render, RefusesWhatCannotBeDrawn) {
  const std::string nothing = "no triangle has an area; there is nothing to draw";
  EXPECT_EQ(complaint({.mesh = TriangleMesh()}), nothing);
  EXPECT_EQ(complaint({.mesh = make_mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}})}),
            nothing);
  EXPECT_EQ(complaint({.mesh = make_mesh({{5, 5, 5}}, {{0, 0, 0}})}), nothing);
  const TriangleMesh mesh = tetrahedron();
  EXPECT_EQ(complaint({.mesh = mesh, .markers = {{4, Colour::Zero()}}}),
            "marker: 4 is no vertex; there are 4, from 0");
  EXPECT_EQ(complaint({.mesh = mesh, .colours = VertexColours::Zero(3, 3)}),
            "colours: are 3, but the mesh has 4 vertices");
}

TEST(Render, StopsWhenAsked) {
  RenderOptions options = kSmall;
  options.progress = [](const ProgressStep&) { return false; };
  const TriangleMesh mesh = tetrahedron();
  EXPECT_THROW((void)render({.mesh = mesh}, {kFront}, options), Error);
}

TEST(Render, DrawsSeveralViewsAtOneScale) {
  // A rod along x: from its end it is a small dot, not a large one.
  const TriangleMesh rod = make_ellipsoid(1.0, 0.1, 0.1, 8);
  const std::vector<Image> both = render({.mesh = rod}, {kFront, {90.0, 0.0}}, kSmall);
  EXPECT_LT(covered(both[1]), 0.2 * covered(both[0]));
}

TEST(UpAxis, TurnsTheNamedAxisUp) {
  const std::array axes = {UpAxis::x,       UpAxis::y,       UpAxis::z,
                           UpAxis::minus_x, UpAxis::minus_y, UpAxis::minus_z};
  for (int i = 0; i < 6; ++i) {
    const Eigen::Matrix3d rotation = rotation_to_y_up(axes[static_cast<std::size_t>(i)]);
    const Eigen::Vector3d axis = (i < 3 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(i % 3);
    EXPECT_EQ(rotation * axis, Eigen::Vector3d::UnitY());
    EXPECT_EQ(rotation * rotation.transpose(), Eigen::Matrix3d::Identity());
    EXPECT_EQ(rotation.row(0).cross(rotation.row(1)), rotation.row(2));
  }
}

TEST(ToPng, HoldsThePixels) {
  const Image image = tile({draw(tetrahedron()), draw(make_sphere(3)), draw(grid(2))}, 2);
  EXPECT_EQ(image.width, 192);
  EXPECT_EQ(image.height, 192);
  const std::string png = to_png(image);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  int width = 0;
  int height = 0;
  int channels = 0;
  stbi_uc* const decoded =
      stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(png.data()),
                            static_cast<int>(png.size()), &width, &height, &channels, 4);
  ASSERT_NE(decoded, nullptr);
  EXPECT_EQ(width, image.width);
  EXPECT_EQ(height, image.height);
  EXPECT_TRUE(std::equal(image.rgba.begin(), image.rgba.end(), decoded));
  stbi_image_free(decoded);
  EXPECT_EQ(pixel(image, 150, 150)[3], 0);  // no fourth picture
}

TEST(CarryColours, MeansWhatArrivesAndFillsNearGaps) {
  const TriangleMesh target = grid(16);
  const VertexColours source = VertexColours::Identity(3, 3);
  const VertexColours carried = carry_colours(source, {0, 0, -1}, target);
  EXPECT_EQ(Eigen::RowVector3f(carried.row(0)), Eigen::RowVector3f(0.5F, 0.5F, 0.0F));
  EXPECT_EQ(carried.row(1), carried.row(0));  // a neighbour
  const VertexColours mixed = carry_colours(source, {0, 0, 0}, grid(2));
  EXPECT_EQ(Eigen::RowVector3f(mixed.row(0)), Eigen::RowVector3f::Constant(1.0F / 3.0F));
  const VertexColours own = matched_colours(source, {5, -1, 5});
  EXPECT_TRUE(std::isnan(own(1, 0)));
  EXPECT_EQ(own(2, 2), 1.0F);
}

TEST(CarryColours, LeavesGreyWhatIsFar) {
  const VertexColours carried =
      carry_colours(VertexColours::Ones(289, 3), std::vector<std::int32_t>(289, 0), grid(16));
  EXPECT_TRUE(std::isnan(carried(288, 0)));
}

TEST(CarryColours, RefusesMapsThatDoNotFit) {
  const VertexColours source = VertexColours::Zero(2, 3);
  const auto complain = [&](const std::vector<std::int32_t>& map) -> std::string {
    try {
      (void)carry_colours(source, map, tetrahedron());
    } catch (const Error& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(complain({0}), "map: has 1 entries, but the source has 2 vertices");
  EXPECT_EQ(complain({0, 4}),
            "map entry 1: 4 is no vertex of the target, which has 4, from 0; -1 stands for none");
}

TEST(PositionColours, TellTheEndsOfEachAxisApart) {
  const TriangleMesh mesh = make_ellipsoid(0.2, 0.5, 1.0, 8);
  const VertexColours colours = position_colours(mesh, UpAxis::y);
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Index low = 0;
    Eigen::Index high = 0;
    mesh.vertices.col(axis).minCoeff(&low);
    mesh.vertices.col(axis).maxCoeff(&high);
    const Eigen::Vector3d difference = to_oklab(colours.row(low)) - to_oklab(colours.row(high));
    EXPECT_GT(difference.norm(), 0.12) << axis;
  }
  EXPECT_GE(colours.minCoeff(), 0.0F);
  EXPECT_LE(colours.maxCoeff(), 1.0F);
}

}  // namespace
}  // namespace timbre::cli

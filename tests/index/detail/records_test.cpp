#include "timbre/index/detail/records.h"

#include <gtest/gtest.h>

#include <limits>

#include "timbre/analysis/core/error.h"
#include "timbre/tests/support/mesh_shapes.h"

namespace timbre::detail {
namespace {

std::string refusal(const TriangleMesh& mesh) {
  try {
    (void)unpack_mesh(pack_mesh(mesh), mesh.vertices.rows(), mesh.faces.rows());
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  return "no error";
}

TEST(UnpackMesh, GivesBackWhatWasPacked) {
  for (const TriangleMesh& mesh : {tetrahedron(), make_mesh({{0, 0, 0}}, {}), make_mesh({}, {})}) {
    const TriangleMesh back = unpack_mesh(pack_mesh(mesh), mesh.vertices.rows(), mesh.faces.rows());
    EXPECT_EQ(back.vertices, mesh.vertices);
    EXPECT_EQ(back.faces, mesh.faces);
  }
}

TEST(UnpackMesh, RefusesAnotherSizeThanSaid) {
  const std::string packed = pack_mesh(tetrahedron());
  const std::int64_t most = std::numeric_limits<std::int64_t>::max();
  for (const auto& [vertices, faces] :
       {std::pair<std::int64_t, std::int64_t>{4, 3}, {3, 4}, {-4, 12}, {most, most}, {0, 0}}) {
    EXPECT_THROW((void)unpack_mesh(packed, vertices, faces), Error);
  }
  EXPECT_THROW((void)unpack_mesh("", 4, 4), Error);
  EXPECT_THROW((void)unpack_mesh(std::string_view(packed).substr(0, packed.size() - 1), 4, 4),
               Error);
}

TEST(UnpackMesh, RefusesWhatIsNoMesh) {
  TriangleMesh mesh = tetrahedron();
  mesh.faces(1, 2) = 4;
  EXPECT_EQ(refusal(mesh), "mesh: holds a corner that is no vertex");
  mesh.faces(1, 2) = -1;
  EXPECT_EQ(refusal(mesh), "mesh: holds a corner that is no vertex");
  mesh.vertices(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(mesh), "mesh: holds a coordinate that is not finite");
}

TEST(UnpackNumbers, GivesBackWhatWasPacked) {
  for (const Eigen::Index count : {0, 1, 7}) {
    const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(count, -1.0, 1.0);
    EXPECT_EQ(unpack_numbers(pack_numbers(values)), values);
  }
}

}  // namespace
}  // namespace timbre::detail

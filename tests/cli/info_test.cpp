#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "timbre/analysis/mesh/write_mesh.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/run_command.h"

namespace timbre {
namespace {

using nlohmann::json;

class Info : public testing::Test {
 protected:
  std::string put(const std::string& name, const std::string& bytes) {
    put_file(folder_ / name, bytes);
    return "'" + (folder_ / name) + "'";
  }
  std::string put(const std::string& name, const TriangleMesh& mesh) {
    return put(name, to_mesh_bytes(mesh, MeshFormat::off));
  }
  static json answer(const std::string& arguments) {
    const Ran ran = run_command("info --json " + arguments);
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_EQ(ran.err, "");
    return json::parse(ran.out);
  }

  TemporaryFolder folder_;
};

TEST_F(Info, AnswersInJson) {
  const json found = answer(put("torus.off", torus(8, 6)));
  EXPECT_EQ(found["vertices"], 48);
  EXPECT_EQ(found["faces"], 96);
  EXPECT_EQ(found["components"], 1);
  EXPECT_EQ(found["boundary_loops"], 0);
  EXPECT_EQ(found["genus"], 1);
  EXPECT_EQ(found["manifold"], true);
  EXPECT_EQ(found["orientable"], true);
  EXPECT_EQ(found["format"], "off");
  EXPECT_GT(found["area"], 60.0);
  EXPECT_GT(found["volume"], 20.0);
  EXPECT_EQ(found["warnings"], json::array());
}

TEST_F(Info, GivesNullForWhatDoesNotExist) {
  const json points = answer(put("points.off", "OFF 1 0 0\n0 0 0\n"));
  EXPECT_TRUE(points["genus"].is_null());
  EXPECT_TRUE(points["volume"].is_null());
  EXPECT_EQ(points["warnings"][0]["code"], "no-faces");
  TriangleMesh huge = tetrahedron();
  huge.vertices *= 1e300;
  EXPECT_TRUE(answer(put("huge.off", huge))["area"].is_null());
}

TEST_F(Info, KeepsJsonValidWhateverTheNameOfTheFile) {
  const json found = answer(put("caf\xe9\n\"\\.off", tetrahedron()));
  EXPECT_NE(found["mesh"].get<std::string>().find("caf\xef\xbf\xbd\n\"\\.off"), std::string::npos);
}

TEST_F(Info, ReadsStandardInput) {
  EXPECT_EQ(answer("- <" + put("a.off", tetrahedron()))["faces"], 4);
}

TEST_F(Info, KeepsSoupAndHoldsTheLimitOnRequest) {
  const std::string stl = put("a.stl",
                              "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                              "vertex 0 0 0\nendloop\nendfacet\nendsolid\n");
  EXPECT_EQ(answer(stl)["vertices"], 2);
  EXPECT_EQ(answer("--soup " + stl)["vertices"], 3);
  EXPECT_EQ(run_command("info --size-limit 10 " + stl).exit_code, 1);
}

TEST_F(Info, SaysInWordsWhatAFindingMeans) {
  TriangleMesh mesh = grid(2);
  mesh.vertices.conservativeResize(10, 3);
  mesh.vertices.row(9).setZero();
  const Ran ran = run_command("info " + put("grid.off", mesh));
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(ran.out, (folder_ / "grid.off") +
                         ": off, 10 vertices, 8 triangles\n"
                         "surface: 1 component, 1 boundary loop, manifold, orientable, genus 0\n"
                         "area: 1\n"
                         "edges: 0.5 to 0.707, mean 0.569; smallest angle 45 degrees\n"
                         "- boundary loops: 1; the natural (Neumann) condition holds there; "
                         "--boundary dirichlet sets functions to 0\n"
                         "- vertices at the place of an earlier one: 1 (9); they stay apart: a "
                         "seam along them is a slit, open like a boundary, until you weld them\n"
                         "- vertices in no triangle: 1 (9); they keep their number, eigenfunctions "
                         "are 0 there\n");
  EXPECT_EQ(ran.err, "");
}

TEST_F(Info, RefusesBadInputInOneLine) {
  const Ran ran = run_command("info --json " + put("a\nb.off", "OFF 1 0 0\n0 0 x\n"));
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_EQ(ran.out, "");
  EXPECT_EQ(ran.err, "timbre: " + (folder_ / "a\\nb.off") +
                         ": line 2, vertex 0: 'x' is not a decimal number in the range of a "
                         "double\n");
}

TEST_F(Info, TellsUsageErrorsApart) {
  EXPECT_EQ(run_command("info").exit_code, 2);
  EXPECT_EQ(run_command("info --no-such-option").exit_code, 2);
  EXPECT_EQ(run_command("info --size-limit x a.off").exit_code, 2);
  EXPECT_EQ(run_command("info --help").exit_code, 0);
}

TEST_F(Info, WritesAPageWithEachDefectMarked) {
  // A fin on a closed body: an edge of three triangles, and a boundary.
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.conservativeResize(5, 3);
  mesh.vertices.row(4) << 2, 2, 2;
  mesh.faces.conservativeResize(5, 3);
  mesh.faces.row(4) << 1, 2, 4;
  const std::string file = put("<fin>.off", mesh);
  const std::string page = folder_ / "page.html";
  const Ran ran = run_command("info " + file + " --report " + page);
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_NE(ran.out.find("edges of three or more triangles: 1 (1-2)"), std::string::npos);
  const std::string html = file_content(page);
  EXPECT_NE(html.find("<h1>&lt;fin&gt;.off</h1>"), std::string::npos);
  EXPECT_NE(html.find("edges of three or more triangles: 1"), std::string::npos);
  EXPECT_NE(html.find("(1-2)"), std::string::npos);
  EXPECT_NE(html.find("boundary loops: 1"), std::string::npos);
  EXPECT_EQ(html.find("://"), std::string::npos);
  std::size_t pictures = 0;
  for (std::size_t at = 0; (at = html.find("<img src=\"data:", at)) != std::string::npos; ++at) {
    ++pictures;
  }
  EXPECT_EQ(pictures, 4U);
  EXPECT_EQ(run_command("info " + file + " --report " + page).exit_code, 2);  // is there already
  EXPECT_EQ(run_command("info " + file + " --report -").exit_code, 2);
}

TEST_F(Info, WritesAPageOfPointsOnly) {
  const std::string page = folder_ / "page.html";
  const Ran ran =
      run_command("info " + put("points.off", "OFF 1 0 0\n0 0 0\n") + " --report " + page);
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_NE(file_content(page).find("Nothing to draw"), std::string::npos);
}

}  // namespace
}  // namespace timbre

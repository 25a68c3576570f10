#include <gtest/gtest.h>

#include <limits>

#include "timbre/analysis/mesh/write_mesh.h"
#include "timbre/tests/support/byte_order.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/read_text.h"

namespace timbre {
namespace {

using Bytes = std::string;

const std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();

Bytes chunk(const std::string& kind, const Bytes& content) {
  return little_endian({static_cast<std::uint32_t>(content.size())}) + kind + content;
}

Bytes file_of(const Bytes& chunks, std::uint32_t version = 2) {
  return "glTF" + little_endian({version, static_cast<std::uint32_t>(12 + chunks.size())}) + chunks;
}

const std::string kBin("BIN\0", 4);

Bytes glb(const std::string& json, const Bytes& bin) {
  return file_of(chunk("JSON", json) + (bin.empty() ? "" : chunk(kBin, bin)));
}

// The unit square as positions, then its two triangles as indices of each size.
const Bytes kSquare = little_endian<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) +
                      little_endian<std::uint8_t>({0, 1, 2, 0, 2, 3}) + "  " +
                      little_endian<std::uint16_t>({0, 1, 2, 0, 2, 3}) +
                      little_endian<std::uint32_t>({0, 1, 2, 0, 2, 3});

const std::string kArrays = R"(
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
{"bufferView":1,"componentType":5121,"count":6,"type":"SCALAR"},
{"bufferView":1,"byteOffset":8,"componentType":5123,"count":6,"type":"SCALAR"},
{"bufferView":1,"byteOffset":20,"componentType":5125,"count":6,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":44}],
"buffers":[{"byteLength":92}]})";

std::string meshes_of(const std::string& primitives) {
  return R"("meshes":[{"primitives":[)" + primitives + "]}],";
}

const std::string kPrimitive = R"({"attributes":{"POSITION":0},"indices":1})";
const std::string kMeshes = meshes_of(kPrimitive);

// A document with these members beside the square's arrays.
std::string json_of(const std::string& members) { return "{" + members + kArrays; }

MeshFile read(const Bytes& bytes) { return read_mesh_bytes(bytes, "m.glb"); }
MeshFile read_json(const std::string& json) { return read(glb(json, kSquare)); }
MeshFile read_nodes(const std::string& members) { return read_json(json_of(members + kMeshes)); }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

using Row = Eigen::RowVector3d;
using Corners = Eigen::RowVector3i;

TEST(ReadGlb, ReadsMeshesWithoutScenesAndNodes) {
  const MeshFile file = read_json(json_of(kMeshes));
  EXPECT_EQ(file.format, "glb");
  EXPECT_EQ(summary(file), "4/2");
  EXPECT_EQ(file.mesh.vertices.row(2), Row(1, 1, 0));
  EXPECT_EQ(file.mesh.faces.row(1), Corners(0, 2, 3));
  EXPECT_EQ(summary(read_mesh_bytes(glb(json_of(kMeshes), kSquare), "m.off")), "4/2");
}

TEST(ReadGlb, ReadsIndicesOfEverySizeAndNone) {
  for (const std::string accessor : {"1", "2", "3"}) {
    const MeshFile file = read_json(
        json_of(meshes_of(R"({"attributes":{"POSITION":0},"indices":)" + accessor + "}")));
    EXPECT_EQ(file.mesh.faces.row(1), Corners(0, 2, 3));
  }
  const std::string three = replaced(json_of(meshes_of(R"({"attributes":{"POSITION":0}})")),
                                     R"("count":4)", R"("count":3)");
  EXPECT_EQ(read_json(three).mesh.faces.row(0), Corners(0, 1, 2));
}

TEST(ReadGlb, ReadsStripsAndFans) {
  const auto faces = [](const std::string& mode) {
    return read_json(json_of(meshes_of(R"({"attributes":{"POSITION":0},"mode":)" + mode + "}")))
        .mesh.faces;
  };
  EXPECT_EQ(faces("5").row(0), Corners(0, 1, 2));
  EXPECT_EQ(faces("5").row(1), Corners(1, 3, 2));
  EXPECT_EQ(faces("6").row(0), Corners(1, 2, 0));
  EXPECT_EQ(faces("6").row(1), Corners(2, 3, 0));
}

TEST(ReadGlb, DropsPointsAndLines) {
  const std::string primitives = R"({"mode":0},{"mode":1},{"mode":2},{"mode":3},)" + kPrimitive;
  EXPECT_EQ(summary(read_json(json_of(meshes_of(primitives)))), "4/2 dropped-element=4");
  const std::string two = R"({"attributes":{"POSITION":0},"mode":5})";
  EXPECT_EQ(summary(read_json(replaced(json_of(meshes_of(two)), R"("count":4)", R"("count":2)"))),
            "2/0 dropped-element=1 no-faces=1");
}

TEST(ReadGlb, SharesVerticesOfPrimitivesWithTheSamePositions) {
  EXPECT_EQ(summary(read_json(json_of(meshes_of(kPrimitive + "," + kPrimitive)))),
            "4/4 duplicate-face=2");
}

TEST(ReadGlb, KeepsVerticesOfOtherPositionsApart) {
  const std::string json =
      replaced(json_of(meshes_of(kPrimitive + R"(,{"attributes":{"POSITION":4},"indices":1})")),
               R"(}],
"bufferViews")",
               R"(},{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}],
"bufferViews")");
  const MeshFile file = read_json(json);
  EXPECT_EQ(summary(file), "8/4 coincident-vertex=4");
  EXPECT_EQ(file.mesh.faces.row(3), Corners(4, 6, 7));
}

TEST(ReadGlb, RespectsStrides) {
  const Bytes bin = little_endian<float>({7, 0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0});
  EXPECT_EQ(summary(read(glb(
                R"({"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"byteOffset":4,"componentType":5126,"count":3,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteLength":48,"byteStride":16}],"buffers":[{"byteLength":48}]})",
                bin))),
            "3/1");
}

TEST(ReadGlb, PlacesMeshesAsNodesSay) {
  const std::string nodes = R"("scene":0,"scenes":[{"nodes":[1]}],"nodes":[
{"mesh":0,"rotation":[0,0,2,2]},
{"children":[0],"translation":[10,20,30],"scale":[2,3,4]}],)";
  const MeshFile file = read_nodes(nodes);
  EXPECT_EQ(summary(file), "4/2");
  EXPECT_TRUE(file.mesh.vertices.row(1).isApprox(Row(10, 23, 30)));
  EXPECT_TRUE(file.mesh.vertices.row(3).isApprox(Row(8, 20, 30)));
  const MeshFile same =
      read_nodes(R"("nodes":[{"mesh":0,"matrix":[0,3,0,0,-2,0,0,0,0,0,4,0,10,20,30,1]}],)");
  EXPECT_TRUE(same.mesh.vertices.isApprox(file.mesh.vertices));
  EXPECT_EQ(same.mesh.faces, file.mesh.faces);
}

TEST(ReadGlb, ReadsAMeshOnceForEachNodeInOrder) {
  const MeshFile file = read_nodes(R"("nodes":[{"children":[1,2]},
{"mesh":0,"translation":[5,0,0]},{"mesh":0,"translation":[9,0,0]}],)");
  EXPECT_EQ(summary(file), "8/4");
  EXPECT_EQ(file.mesh.vertices.row(0), Row(5, 0, 0));
  EXPECT_EQ(file.mesh.vertices.row(4), Row(9, 0, 0));
  EXPECT_EQ(file.mesh.faces.row(2), Corners(4, 5, 6));
}

TEST(ReadGlb, TurnsTrianglesRoundUnderAMirror) {
  EXPECT_EQ(read_nodes(R"("nodes":[{"mesh":0,"scale":[1,-1,1]}],)").mesh.faces.row(0),
            Corners(0, 2, 1));
  EXPECT_EQ(
      read_nodes(R"("nodes":[{"mesh":0,"scale":[-1e-200,1e-200,1e-200]}],)").mesh.faces.row(0),
      Corners(0, 2, 1));
  EXPECT_EQ(read_nodes(R"("nodes":[{"mesh":0,"scale":[-1,-1,1]}],)").mesh.faces.row(0),
            Corners(0, 1, 2));
}

TEST(ReadGlb, ReadsTheDefaultSceneOrTheFirst) {
  const std::string scenes = R"("scenes":[{"nodes":[0]},{"nodes":[0,1]},{}],
"nodes":[{"mesh":0},{"mesh":0,"translation":[5,0,0]}],)";
  EXPECT_EQ(summary(read_nodes(scenes)), "4/2");
  EXPECT_EQ(summary(read_nodes(R"("scene":1,)" + scenes)), "8/4");
  EXPECT_EQ(summary(read_nodes(R"("scene":2,)" + scenes)), "0/0 no-faces=1");
}

TEST(ReadGlb, ReadsSkinnedAndMorphedMeshesAsModelled) {
  const std::string primitive = replaced(kPrimitive, "{", R"({"targets":[{"POSITION":0}],)");
  const MeshFile file = read_json(json_of(R"("nodes":[{"mesh":0,"skin":0,"translation":[5,0,0],
"extensions":{"EXT_mesh_gpu_instancing":{}}}],)" +
                                          meshes_of(primitive)));
  EXPECT_EQ(summary(file), "4/2 ignored-data=3");
  EXPECT_EQ(file.mesh.vertices.row(0), Row(0, 0, 0));
}

TEST(ReadGlb, AllowsExtensionsThatKeepGeometry) {
  EXPECT_EQ(summary(read_nodes(R"("extensionsRequired":["KHR_materials_unlit",
"KHR_texture_transform","KHR_lights_punctual","KHR_mesh_quantization"],)")),
            "4/2");
}

TEST(ReadGlb, PassesOverOtherChunksAndTheEnd) {
  const Bytes json = chunk("JSON", json_of(kMeshes) + "  ");
  const Bytes bin = chunk(kBin, kSquare);
  EXPECT_EQ(summary(read(file_of(json + bin + chunk("MORE", "abc")))), "4/2");
  EXPECT_EQ(summary(read(file_of(json + bin) + " \n")), "4/2");
  EXPECT_EQ(summary(read(file_of(json + bin) + "x")), "4/2 trailing-data=1");
  EXPECT_EQ(refusal(file_of(json + chunk("MORE", "abc") + bin), "m.glb"),
            "m.glb: buffer 0: 92 bytes are declared, the BIN chunk has 0");
  EXPECT_EQ(summary(read(glb("{}", ""))), "0/0 no-faces=1");
}

TEST(ReadGlb, RefusesBrokenContainers) {
  const Bytes json = chunk("JSON", "{}");
  const auto with_length = [&](std::uint32_t length) {
    return "glTF" + little_endian<std::uint32_t>({2, length}) + json;
  };
  expect_refused(
      {
          {"glTF", "byte 4: truncated: 4 bytes are needed, 0 are left"},
          {file_of(json, 1), "byte 4: glTF version 1; version 2 is read"},
          {with_length(19), "byte 8: a length of 19 bytes; 20 is the least"},
          {with_length(23), "byte 8: truncated: 23 bytes are declared, the file has 22"},
          {file_of(chunk(kBin, "{}")), "byte 16: the first chunk must be 'JSON'"},
          {with_length(21), "byte 20: truncated: 2 bytes are needed, 1 are left"},
          {file_of(json + "ab"), "byte 22: truncated: 4 bytes are needed, 2 are left"},
          {file_of(json + little_endian<std::uint32_t>({kMost, 0})),
           "byte 30: truncated: 4294967295 bytes are needed, 0 are left"},
          {glb("{", ""), "byte 21: the JSON cannot be read from here on"},
          {glb("{]", ""), "byte 21: the JSON cannot be read from here on"},
          {glb("[]", ""), "JSON: a JSON object is needed"},
          {glb("[1e999]", ""), "byte 20: the JSON holds a number beyond the range of a double"},
          {glb(std::string(100000, '['), ""), "byte 84: the JSON is nested deeper than 64"},
          {glb(R"({"\"":")" + std::string(100, '{') + R"(","a":)" + std::string(99, '['), ""),
           "byte 196: the JSON is nested deeper than 64"},
      },
      "m.glb");
}

struct Change {
  std::string from;
  std::string to;
  std::string line;
};

TEST(ReadGlb, RefusesDocumentsWithPlaceAndCause) {
  const std::string valid = json_of(R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)" + kMeshes);
  const std::string positions = R"("bufferView":0,"componentType":5126,"count":4,"type":"VEC3")";
  const std::string indices = R"("bufferView":1,"componentType":5121,"count":6,"type":"SCALAR")";
  const std::vector<Change> changes = {
      {R"("scenes":[{)", R"("scenes":3,"a":[{)", "JSON: 'scenes' is no list"},
      {R"("scenes")", R"("scene":1,"scenes")", "scene 1: there is none; 'scenes' has 1"},
      {R"("nodes":[0])", R"("nodes":[-1])",
       "scene 0: 'nodes' needs whole numbers from 0 to 4294967295"},
      {R"("nodes":[0])", R"("nodes":[0.0])",
       "scene 0: 'nodes' needs whole numbers from 0 to 4294967295"},
      {R"("nodes":[0])", R"("nodes":[4294967296])",
       "scene 0: 'nodes' needs whole numbers from 0 to 4294967295"},
      {R"("nodes":[0])", R"("nodes":[1])", "node 1: there is none; 'nodes' has 1"},
      {R"("nodes":[0])", R"("nodes":[0,0])",
       "node 0: lies in two nodes, or in itself; nodes must form a tree"},
      {R"({"mesh":0})", "[]", "node 0: a JSON object is needed"},
      {R"({"mesh":0})", R"({"mesh":1})", "mesh 1: there is none; 'meshes' has 1"},
      {R"({"mesh":0})", R"({"children":[0]})",
       "node 0: lies in two nodes, or in itself; nodes must form a tree"},
      {R"({"mesh":0})", R"({"matrix":[1,2]})", "node 0: 'matrix' needs 16 numbers"},
      {R"({"mesh":0})", R"({"scale":[1,2,"3"]})", "node 0: 'scale' needs 3 numbers"},
      {R"({"mesh":0})", R"({"matrix":[1,0,0,0,0,1,0,0,0,0,1,0.5,0,0,0,1]})",
       "node 0: the last row of 'matrix' is not 0 0 0 1"},
      {R"({"mesh":0})", R"({"scale":[1,1,1],"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]})",
       "node 0: has both 'matrix' and 'translation', 'rotation' or 'scale'"},
      {R"({"mesh":0})", R"({"rotation":[0,0,0,0]})", "node 0: 'rotation' is 0 0 0 0"},
      {R"({"mesh":0})", R"({"mesh":0,"scale":[1e308,1e308,1e308],"translation":[1e308,0,0]})",
       "byte 644, vertex 1: its node moves it beyond the range of a double"},
      {R"("attributes")", R"("mode":7,"attributes")",
       "mesh 0, primitive 0: mode 7 is unknown; 0 to 6 are points to fans"},
      {R"("attributes")", R"("a")", "mesh 0, primitive 0: 'attributes' is missing"},
      {R"("POSITION")", R"("NORMAL")", "mesh 0, primitive 0: 'POSITION' is missing"},
      {R"("POSITION":0)", R"("POSITION":7)", "accessor 7: there is none; 'accessors' has 4"},
      {R"("POSITION":0)", R"("POSITION":1)", "accessor 1: positions need the type 'VEC3'"},
      {R"("indices":1)", R"("indices":0)", "accessor 0: indices need the type 'SCALAR'"},
      {positions, R"("type":3)", "accessor 0: 'type' is missing"},
      {positions, R"("componentType":5123,"type":"VEC3")",
       "accessor 0: positions that are not 32-bit floats (KHR_mesh_quantization); save it without "
       "quantization"},
      {positions, positions + R"(,"sparse":{})", "accessor 0: is sparse; save it with all values"},
      {positions, R"("componentType":5126,"count":4,"type":"VEC3")",
       "accessor 0: has no 'bufferView'; save it without compression, with all values"},
      {positions, R"("bufferView":0,"componentType":5126,"type":"VEC3")",
       "accessor 0: 'count' is missing"},
      {R"("count":4)", R"("count":5)",
       "accessor 0: 5 elements go beyond the end of its bufferView"},
      {R"("count":4)", R"("count":4294967295)",
       "accessor 0: 4294967295 elements go beyond the end of its bufferView"},
      {positions, positions + R"(,"byteOffset":1)",
       "accessor 0: 4 elements go beyond the end of its bufferView"},
      {indices, R"("bufferView":1,"componentType":5124,"count":6,"type":"SCALAR")",
       "accessor 1: indices need unsigned integers: componentType 5121, 5123 or 5125"},
      {indices, R"("bufferView":1,"componentType":5121,"count":5,"type":"SCALAR")",
       "mesh 0, primitive 0: 5 corners; triangles have three each"},
      {indices, R"("bufferView":1,"componentType":5121,"count":9,"type":"SCALAR")",
       "byte 624, face 2: index 32 is out of range; the primitive has 4 vertices"},
      {R"("byteLength":48)", R"("byteLength":48,"byteStride":8)",
       "bufferView 0: a stride of 8 bytes for elements of 12"},
      {R"("byteLength":48)", R"("byteLength":93)",
       "bufferView 0: goes beyond the end of its buffer"},
      {R"("buffer":0,"byteLength":48)", R"("buffer":1,"byteLength":48)",
       "buffer 1: there is none; 'buffers' has 1"},
      {R"([{"byteLength":92}])", R"([{"byteLength":93}])",
       "buffer 0: 93 bytes are declared, the BIN chunk has 92"},
      {R"([{"byteLength":92}])", R"([{"byteLength":92,"uri":"data:,"}])",
       "buffer 0: lies outside the BIN chunk; save it as one self-contained .glb"},
      {"{", R"({"extensionsRequired":[1],)", "JSON: 'extensionsRequired' needs words"},
      {"{", R"({"extensionsRequired":["KHR_draco_mesh_compression"],)",
       "JSON: the geometry is compressed with 'KHR_draco_mesh_compression'; save it without "
       "compression"},
      {"{", R"({"extensionsRequired":["EXT_meshopt_compression"],)",
       "JSON: the geometry is compressed with 'EXT_meshopt_compression'; save it without "
       "compression"},
      {"{", R"({"extensionsRequired":["EXT_x"],)",
       "JSON: the extension 'EXT_x' is needed to read this file and is not known; save it without"},
  };
  std::vector<Refused> cases;
  cases.reserve(changes.size());
  for (const Change& change : changes) {
    cases.push_back({glb(replaced(valid, change.from, change.to), kSquare), change.line});
  }
  expect_refused(cases, "m.glb");
}

TEST(ReadGlb, RefusesNodesInACircleWithoutAScene) {
  expect_refused(
      {{glb(json_of(R"("nodes":[{"mesh":0},{"children":[2]},{"children":[1]}],)" + kMeshes),
            kSquare),
        "node 1: lies in two nodes, or in itself; nodes must form a tree"}},
      "m.glb");
}

TEST(ReadGlb, RefusesBadCoordinatesAndIndices) {
  const float inf = std::numeric_limits<float>::infinity();
  const std::string json = json_of(kMeshes);
  const std::size_t bin = 28 + json.size();
  const auto byte = [bin](std::size_t offset) { return "byte " + std::to_string(bin + offset); };
  Bytes infinite = kSquare;
  infinite.replace(20, 4, little_endian({inf}));
  Bytes beyond = kSquare;
  beyond[52] = '\xff';
  expect_refused({{glb(json, infinite), byte(20) + ", vertex 1: coordinate is not finite"},
                  {glb(json, beyond),
                   byte(52) + ", face 1: index 255 is out of range; the primitive has 4 vertices"}},
                 "m.glb");
}

TEST(ReadGlb, BoundsWhatAFewBytesMayPlace) {
  const auto mesh_placed = [](std::size_t times) {
    std::string nodes = R"("nodes":[{"mesh":0})";
    for (std::size_t i = 1; i < times; ++i) nodes += R"(,{"mesh":0})";
    std::string primitives = kPrimitive;
    for (int i = 1; i < 300; ++i) primitives += "," + kPrimitive;
    return glb(json_of(nodes + "]," + meshes_of(primitives)), kSquare);
  };
  EXPECT_EQ(read(mesh_placed(10)).mesh.faces.rows(), 6000);
  EXPECT_EQ(refusal(mesh_placed(1000), "m.glb"),
            "m.glb: mesh 0, primitive 12: placed so often that the mesh has more than 16 vertices "
            "and corners for each byte of the file");
}

TEST(ReadGlb, FollowsDeepTreesOfNodes) {
  constexpr int kDepth = 100000;
  std::string nodes = R"("nodes":[)";
  for (int i = 1; i < kDepth; ++i) nodes += R"({"children":[)" + std::to_string(i) + "]},";
  EXPECT_EQ(summary(read_nodes(nodes + R"({"mesh":0}],)")), "4/2");
}

TEST(ReadGlb, SeesEveryCut) {
  expect_cuts_are_seen(glb(json_of(kMeshes), kSquare), "m.glb");
  expect_cuts_are_seen(to_mesh_bytes(tetrahedron(), MeshFormat::glb), "m.glb");
}

}  // namespace
}  // namespace timbre

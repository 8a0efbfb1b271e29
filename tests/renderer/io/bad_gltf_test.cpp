#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "renderer/io/load_gltf.h"
#include "renderer/io/save_gltf.h"
#include "tests/renderer/io/gltf_builder.h"
#include "tests/support/test_names.h"

namespace chiaro::renderer::tests {
namespace {

struct BadCase {
  const char* name;
  std::function<void(GltfBuilder&)> spoil;
  const char* expected;  // part of the message
};

std::string spoilt(const BadCase& bad) {
  GltfBuilder gltf = triangle_scene();
  bad.spoil(gltf);
  return gltf.glb();
}

class BadGltf : public testing::TestWithParam<BadCase> {};

TEST_P(BadGltf, IsRefusedWithOneLineThatNamesThePlace) {
  const TemporaryFolder folder;
  const auto path = folder.write("bad.glb", spoilt(GetParam()));
  const std::string message = error_of([&] { renderer::load_gltf(path); });
  EXPECT_NE(message.find("bad.glb: "), std::string::npos) << message;
  EXPECT_NE(message.find(GetParam().expected), std::string::npos) << message;
  EXPECT_NE(message.find(" (expected "), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

using J = ordered_json;

const BadCase kBadCases[] = {
    {"NoAsset", [](GltfBuilder& g) { g.root.erase("asset"); }, "asset: is missing (expected a glTF 2.0 scene)"},
    {"Version1", [](GltfBuilder& g) { g.root["asset"]["version"] = "1.0"; }, "asset.version"},
    {"RequiredExtension", [](GltfBuilder& g) { g.root["extensionsRequired"] = {"KHR_materials_dispersion"}; },
     "KHR_materials_dispersion"},
    {"MeshOutOfRange", [](GltfBuilder& g) { g.root["nodes"][0]["mesh"] = 1; }, "nodes[0].mesh: 1 is out of range"},
    {"NestedTooDeeply",
     [](GltfBuilder& g) {
       J nested = 1;
       for (int level = 0; level < 300; ++level) nested = J::array({nested});
       g.root["extras"] = nested;
     },
     "JSON: is nested too deeply (expected at most 256 levels)"},
    {"NegativeIndex", [](GltfBuilder& g) { g.root["nodes"][0]["mesh"] = -1; }, "nodes[0].mesh"},
    {"StringIndex", [](GltfBuilder& g) { g.root["nodes"][0]["mesh"] = "0"; }, "nodes[0].mesh"},
    {"NodesNotAnArray", [](GltfBuilder& g) { g.root["nodes"] = 3; }, "nodes: is of the wrong type"},
    {"ItsOwnChild", [](GltfBuilder& g) { g.root["nodes"][0]["children"] = {0}; }, "nodes[0]: is its own ancestor"},
    {"Cycle",
     [](GltfBuilder& g) {
       g.root["nodes"][0]["children"] = {1};
       g.add_node({{"children", {0}}});
     },
     "is its own ancestor"},
    {"TwoParents",
     [](GltfBuilder& g) {
       g.add_node({{"children", {0}}});
       g.add_node({{"children", {0}}});
     },
     "nodes[0]: is a child of nodes[1] and of nodes[2]"},
    {"ShortMatrix",
     [](GltfBuilder& g) {
       g.root["nodes"][0]["matrix"] = {1, 2, 3};
     },
     "nodes[0].matrix"},
    {"TransposedMatrix",
     [](GltfBuilder& g) { g.root["nodes"][0]["matrix"] = {1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1}; },
     "nodes[0].matrix: element 3 is 5"},
    {"MatrixThatDivides",
     [](GltfBuilder& g) { g.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2}; },
     "nodes[0].matrix: element 15 is 2"},
    {"ColoursOfWholeNumbers",
     [](GltfBuilder& g) {
       g.primitive()["attributes"]["COLOR_0"] =
           g.add_accessor<std::uint8_t>({1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0}, 4, kUnsignedByte);
     },
     "COLOR_0: has whole numbers that are not normalized"},
    {"NormalsOfWholeNumbers",
     [](GltfBuilder& g) {
       g.primitive()["attributes"]["NORMAL"] = g.add_accessor<std::int8_t>({0, 0, 9, 0, 0, 9, 0, 0, 9}, 3, kByte);
     },
     "NORMAL: has whole numbers that are not normalized"},
    {"MatrixAndScale",
     [](GltfBuilder& g) {
       g.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
       g.root["nodes"][0]["scale"] = {2, 2, 2};
     },
     "nodes[0]: has a matrix and a scale (expected one or the other)"},
    {"RotationOfNoDirection",
     [](GltfBuilder& g) {
       g.root["nodes"][0]["rotation"] = {0, 0, 0, 0};
     },
     "nodes[0].rotation: is of no direction"},
    {"InstanceOfNoDirection",
     [](GltfBuilder& g) {
       const int rotations = g.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 0}, 4, kFloat);
       g.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] = rotations;
     },
     "nodes[0]: instance 1 is not finite"},
    {"UnknownWrap",
     [](GltfBuilder& g) {
       g.root["images"] = J::array({{{"uri", "t.png"}}});
       g.root["samplers"] = J::array({{{"wrapT", 10496}}});
       g.root["textures"] = J::array({{{"source", 0}, {"sampler", 0}}});
       g.root["materials"] = J::array({{{"normalTexture", {{"index", 0}}}}});
     },
     "samplers[0].wrapT: is 10496"},
    {"WeightsOfOtherMorphTargets",
     [](GltfBuilder& g) {
       g.primitive()["targets"] = J::array({{{"POSITION", 0}}});
       g.root["meshes"][0]["weights"] = {0.5, 0.5};
     },
     "meshes[0].primitives[0]: has 1 morph targets (expected 2, as there are weights)"},
    {"HugeScale",
     [](GltfBuilder& g) {
       g.root["nodes"][0]["scale"] = {1e39, 1, 1};
     },
     "nodes[0].scale"},
    {"OverflowingTransform",
     [](GltfBuilder& g) {
       g.root["nodes"][0]["scale"] = {1e30, 1e30, 1e30};
       g.add_node({{"children", {0}}, {"scale", {1e30, 1e30, 1e30}}});
     },
     "not finite"},
    {"HugeCount", [](GltfBuilder& g) { g.root["accessors"][0]["count"] = 4000000000U; }, "reach beyond bufferViews[0]"},
    {"HugeCountWithoutData",
     [](GltfBuilder& g) {
       g.root["accessors"][0].erase("bufferView");
       g.root["accessors"][0]["count"] = 4000000000U;
     },
     "without a bufferView"},
    {"CountOverflowsSize", [](GltfBuilder& g) { g.root["accessors"][0]["count"] = 0x2000000000000000ULL; },
     "reach beyond"},
    {"OffsetBeyondView", [](GltfBuilder& g) { g.root["accessors"][0]["byteOffset"] = 40; }, "reach beyond"},
    {"ViewBeyondBuffer", [](GltfBuilder& g) { g.root["bufferViews"][0]["byteLength"] = 37; },
     "reach beyond buffers[0]"},
    {"ViewOffsetOverflows", [](GltfBuilder& g) { g.root["bufferViews"][0]["byteOffset"] = 0xFFFFFFFFFFFFFFF0ULL; },
     "reach beyond buffers[0]"},
    {"StrideTooSmall", [](GltfBuilder& g) { g.root["bufferViews"][0]["byteStride"] = 8; }, "byteStride"},
    {"MatrixPositions", [](GltfBuilder& g) { g.root["accessors"][0]["type"] = "MAT4"; }, "accessors[0]"},
    {"TwoComponentPositions", [](GltfBuilder& g) { g.root["accessors"][0]["type"] = "VEC2"; }, "2 components"},
    {"UnknownComponentType", [](GltfBuilder& g) { g.root["accessors"][0]["componentType"] = 5127; }, "componentType"},
    {"BufferLongerThanData",
     [](GltfBuilder& g) {
       g.root["buffers"] = J::array({{{"byteLength", 1000}}});
     },
     "buffers[0]: has 36 bytes"},
    {"IndexOutOfRange",
     [](GltfBuilder& g) {
       g.primitive()["indices"] = g.add_accessor<std::uint8_t>({0, 1, 3}, 1, kUnsignedByte);
     },
     "meshes[0].primitives[0].indices: index 2 is 3"},
    {"FloatIndices",
     [](GltfBuilder& g) {
       g.primitive()["indices"] = g.add_accessor<float>({0, 1, 2}, 1, kFloat);
     },
     "unsigned scalars"},
    {"InfinitePosition",
     [](GltfBuilder& g) {
       const float infinity = std::numeric_limits<float>::infinity();
       g.primitive()["attributes"]["POSITION"] = g.add_accessor<float>({0, 0, 0, 1, infinity, 0, 0, 1, 0}, 3, kFloat);
     },
     "vertex 1 is not finite"},
    {"NormalCount",
     [](GltfBuilder& g) {
       g.primitive()["attributes"]["NORMAL"] = g.add_accessor<float>({0, 0, 1}, 3, kFloat);
     },
     "NORMAL: has 1 elements (expected 3"},
    {"SparseIndexOutOfRange",
     [](GltfBuilder& g) {
       const int indices = g.add_view(bytes_of<std::uint8_t>({3}));
       const int values = g.add_view(bytes_of<float>({5, 0, 0}));
       g.root["accessors"][0]["sparse"] = {{"count", 1},
                                           {"indices", {{"bufferView", indices}, {"componentType", kUnsignedByte}}},
                                           {"values", {{"bufferView", values}}}};
     },
     "accessors[0].sparse.indices: 3 is out of range"},
    {"SparseIndicesOutOfOrder",
     [](GltfBuilder& g) {
       const int indices = g.add_view(bytes_of<std::uint8_t>({1, 1}));
       const int values = g.add_view(bytes_of<float>({5, 0, 0, 6, 0, 0}));
       g.root["accessors"][0]["sparse"] = {{"count", 2},
                                           {"indices", {{"bufferView", indices}, {"componentType", kUnsignedByte}}},
                                           {"values", {{"bufferView", values}}}};
     },
     "accessors[0].sparse.indices: 1 comes after 1"},
    {"SparseOffsetOf33Bits",
     [](GltfBuilder& g) {
       const int view = g.add_view(bytes_of<float>({0, 0, 0}));
       g.root["accessors"][0]["sparse"] = {
           {"count", 1},
           {"indices", {{"bufferView", view}, {"componentType", kUnsignedByte}, {"byteOffset", 1ULL << 32}}},
           {"values", {{"bufferView", view}}}};
     },
     "accessors[0].sparse.indices.byteOffset: is 4294967296"},
    {"UnknownMode", [](GltfBuilder& g) { g.primitive()["mode"] = 7; }, "mode"},
    {"MissingTexture",
     [](GltfBuilder& g) {
       g.root["images"] = J::array({{{"uri", "not there.png"}}});
       g.root["textures"] = J::array({{{"source", 0}}});
       g.root["materials"] = J::array({{{"normalTexture", {{"index", 0}}}}});
     },
     "images[0].uri: no such file: \"not there.png\""},
    {"BrokenTexture",
     [](GltfBuilder& g) {
       g.root["images"] = J::array({{{"bufferView", g.add_view("\x89PNG\r\n\x1a\n and no more")}, {"name", "torn"}}});
       g.root["textures"] = J::array({{{"source", 0}}});
       g.root["materials"] = J::array({{{"normalTexture", {{"index", 0}}}}});
     },
     "images[0] \"torn\""},
    {"VertexBeyondTheWorld",
     [](GltfBuilder& g) {
       g.root["nodes"][0]["scale"] = {2e9, 1, 1};
     },
     "nodes[0]: puts a vertex at 2e+09, 0, 0 (expected within 1e+09 m of the origin)"},
    {"SceneTooSmallForRays",
     [](GltfBuilder& g) {
       g.root["nodes"][0]["scale"] = {1e-6, 1e-6, 1e-6};
     },
     "scene: all surfaces together are 1.41421e-06 m across (expected 1e-05 m or more"},
    {"SceneTooFarAwayForFloats",
     [](GltfBuilder& g) {
       g.root["nodes"][0]["translation"] = {1e6, 0, 0};
     },
     "scene: surfaces 1.41 m across lie 1e+06 m from the origin, where positions are 0.062 m apart (expected a scene "
     "nearer to the origin"},
    {"CameraBeyondTheWorld",
     [](GltfBuilder& g) {
       g.root["cameras"] = J::array({{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}});
       g.add_node({{"camera", 0}, {"translation", {0, -1e30, 0}}});
     },
     "nodes[1]: puts a camera at"},
    {"LightBeyondTheWorld",
     [](GltfBuilder& g) {
       g.root["extensions"]["KHR_lights_punctual"]["lights"] = J::array({{{"type", "point"}}});
       g.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
       g.root["nodes"][0].erase("mesh");
       g.root["nodes"][0]["translation"] = {0, 1.5e9, 0};
     },
     "nodes[0]: puts a light at 0, 1.5e+09, 0"},
    {"AlphaMode",
     [](GltfBuilder& g) {
       g.root["materials"] = J::array({{{"alphaMode", "GLOW"}}});
     },
     "GLOW"},
    {"LightType",
     [](GltfBuilder& g) {
       g.root["extensions"]["KHR_lights_punctual"]["lights"] = J::array({{{"type", "area"}}});
       g.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
     },
     "\"area\""},
    {"NegativeIntensity",
     [](GltfBuilder& g) {
       g.root["extensions"]["KHR_lights_punctual"]["lights"] = J::array({{{"type", "point"}, {"intensity", -1}}});
     },
     "lights[0].intensity"},
};

INSTANTIATE_TEST_SUITE_P(Table, BadGltf, testing::ValuesIn(kBadCases), test::kByName);

TEST(BadGltfBytes, EveryTruncationIsRefused) {
  const TemporaryFolder folder;
  const std::string whole = triangle_scene().glb();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto path = folder.write("cut.glb", whole.substr(0, size));
    EXPECT_NE(error_of([&] { renderer::load_gltf(path); }), "") << size << " of " << whole.size() << " bytes";
  }
}

TEST(BadGltfBytes, WhatAParserPassesOverIsRefused) {
  const TemporaryFolder folder;
  const std::string whole = triangle_scene().container().json;
  const auto error_of_json = [&](const std::string& json) {
    const auto path = folder.write("a.gltf", json);
    return error_of([&] { renderer::load_gltf(path); });
  };
  const auto with = [&](const std::string& members) { return "{" + members + "," + whole.substr(1); };
  const std::string before = error_of_json(with("\"extras\":1"));  // its buffer is in no file
  EXPECT_EQ(before.find("extras"), std::string::npos) << before;
  EXPECT_NE(error_of_json(with("\"extras\":1,\"extras\":2")).find("extras: is there twice in one object"),
            std::string::npos);
  EXPECT_EQ(error_of_json(whole + std::string(3, '\0')), before);
  EXPECT_NE(error_of_json(whole + '\0' + "{}").find("goes on behind a NUL"), std::string::npos);
}

TEST(BadGltfBytes, WhatIsNotAGltfIsRefused) {
  const TemporaryFolder folder;
  const std::string deep = R"({"asset":{"version":"2.0"},"extras":)" + std::string(100000, '[');
  for (const std::string& bytes : {std::string("not a scene"), std::string(), std::string("{"), std::string("[]"),
                                   std::string("{\"asset\":{\"version\":\"2.0\"},\"scene\":1e999}"), deep}) {
    const auto path = folder.write("bad.gltf", bytes);
    EXPECT_NE(error_of([&] { renderer::load_gltf(path); }), "") << bytes.substr(0, 40);
    EXPECT_NE(error_of([&] { renderer::save_gltf_with_lights(path, {}, folder / "out.glb", {}); }), "");
  }
  EXPECT_NE(error_of([&] { renderer::load_gltf(folder / "not there.glb"); }), "");
}

}  // namespace
}  // namespace chiaro::renderer::tests

#include "renderer/io/gltf_animation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/io/load_gltf.h"
#include "tests/renderer/io/gltf_builder.h"
#include "tests/support/test_names.h"

namespace chiaro::renderer::tests {
namespace {

void expect_near(Vec3f a, Vec3f b, float tolerance = 1e-5F) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance) << "axis " << axis;
}

struct Channel {
  std::vector<float> times, values;
  const char* path;
  const char* interpolation = "LINEAR";
  int node = 0;
};

int components_of(const std::string& path) { return path == "rotation" ? 4 : path == "weights" ? 1 : 3; }

int add_animation(GltfBuilder& gltf, const std::vector<Channel>& channels, const std::string& name = "") {
  ordered_json animation = {{"samplers", ordered_json::array()}, {"channels", ordered_json::array()}};
  if (!name.empty()) animation["name"] = name;
  for (const Channel& c : channels) {
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size()}, {"target", {{"node", c.node}, {"path", c.path}}}});
    animation["samplers"].push_back({{"input", gltf.add_accessor(c.times, 1, kFloat)},
                                     {"output", gltf.add_accessor(c.values, components_of(c.path), kFloat)},
                                     {"interpolation", c.interpolation}});
  }
  gltf.root["animations"].push_back(animation);
  return int(gltf.root["animations"].size()) - 1;
}

LoadedScene load(const GltfBuilder& gltf, std::optional<double> seconds, const std::string& animation = "") {
  const TemporaryFolder folder;
  return load_gltf(folder.write("scene.glb", gltf.glb()), {.animation = {animation, seconds}, .variant = {}});
}

Mat4f placed(const GltfBuilder& gltf, std::optional<double> seconds, const std::string& animation = "") {
  return load(gltf, seconds, animation).scene.instances.at(0).world_from_object;
}

Vec3f position(const GltfBuilder& gltf, std::optional<double> seconds, const std::string& animation = "") {
  return placed(gltf, seconds, animation).column(3);
}

TEST(Animation, WhatMovesNoNodeIsSaid) {
  GltfBuilder gltf = triangle_scene();
  add_animation(gltf, {{{0, 1}, {0, 0, 0, 1, 1, 1}, "translation"}});
  gltf.root["animations"][0]["channels"][0]["target"] = {
      {"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", "/nodes/0/translation"}}}}}};
  const LoadedScene loaded = load(gltf, 0.5);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_TRUE(loaded.warnings[0].ends_with(".glb: animations[0].channels[0]: \"pointer\" is not animated here"));
  EXPECT_TRUE(load(gltf, std::nullopt).warnings.empty());
}

TEST(Animation, WithoutATimeNodesStandAsTheFileHasThem) {
  GltfBuilder gltf = triangle_scene();
  gltf.root["nodes"][0]["translation"] = {7, 8, 9};
  add_animation(gltf, {{{0, 1}, {0, 0, 0, 1, 1, 1}, "translation"}});
  expect_near(position(gltf, std::nullopt), {7, 8, 9});
  expect_near(position(gltf, 0.0), {0, 0, 0});
}

TEST(Animation, LinearKeysAreBlendedAndHoldBeyondTheirEnds) {
  GltfBuilder gltf = triangle_scene();
  add_animation(gltf, {{{1, 3, 4}, {0, 0, 0, 2, 4, 6, 0, 0, 0}, "translation"}});
  expect_near(position(gltf, -5.0), {0, 0, 0});
  expect_near(position(gltf, 1.5), {0.5F, 1, 1.5F});
  expect_near(position(gltf, 3.0), {2, 4, 6});
  expect_near(position(gltf, 3.75), {0.5F, 1, 1.5F});
  expect_near(position(gltf, 99.0), {0, 0, 0});
}

TEST(Animation, OfKeysAtOneTimeTheLastHolds) {
  GltfBuilder gltf = triangle_scene();
  add_animation(gltf, {{{0, 1, 1, 2}, {0, 0, 0, 1, 0, 0, 5, 0, 0, 7, 0, 0}, "translation"}});
  expect_near(position(gltf, 0.5), {0.5F, 0, 0});
  expect_near(position(gltf, 1.0), {5, 0, 0});
  expect_near(position(gltf, 1.5), {6, 0, 0});
}

TEST(Animation, StepsHoldUntilTheNextKey) {
  GltfBuilder gltf = triangle_scene();
  add_animation(gltf, {{{0, 1}, {1, 1, 1, 5, 5, 5}, "scale", "STEP"}});
  EXPECT_NEAR(placed(gltf, 0.999).column(0).x, 1, 1e-6);
  EXPECT_NEAR(placed(gltf, 1.0).column(0).x, 5, 1e-6);
}

TEST(Animation, RotationsTakeTheShorterArcAtConstantSpeed) {
  const float h = std::sqrt(0.5F);
  for (const float scale :
       {1.0F, -1.0F, 0.5F, -2.0F}) {  // q and −q are one rotation, and so are others of its direction
    GltfBuilder gltf = triangle_scene();
    add_animation(gltf, {{{0, 1}, {0, 0, 0, 1, 0, 0, scale * h, scale * h}, "rotation"}});
    const float angle = kPi / 2 / 3;
    expect_near(transform_direction(placed(gltf, 1.0 / 3), {1, 0, 0}), {std::cos(angle), std::sin(angle), 0});
  }
}

TEST(Animation, CubicSplinesAreThePolynomialsOfTheirTangents) {
  // x = t³ − t on [0, 2]: slopes −1 and 11. y = t². z constant.
  GltfBuilder gltf = triangle_scene();
  const std::vector<float> values{9, 9, 9, 0, 0, 3, -1, 0, 0, 11, 4, 0, 6, 4, 3, 9, 9, 9};
  add_animation(gltf, {{{0, 2}, values, "translation", "CUBICSPLINE"}});
  for (const double t : {0.0, 0.5, 1.0, 1.7, 2.0}) {
    expect_near(position(gltf, t), {float(t * t * t - t), float(t * t), 3});
  }
  expect_near(position(gltf, 5.0), {6, 4, 3});
}

TEST(Animation, NormalizedIntegersAreRotations) {
  GltfBuilder gltf = triangle_scene();
  add_animation(gltf, {{{0, 1}, {0, 0, 0, 1, 0, 0, 1, 0}, "rotation"}});
  const int packed = gltf.add_accessor<std::int16_t>({0, 0, 0, 32767, 0, 0, 32767, 0}, 4, kShort, true);
  gltf.root["animations"][0]["samplers"][0]["output"] = packed;
  expect_near(transform_direction(placed(gltf, 0.5), {1, 0, 0}), {0, 1, 0}, 1e-4F);
}

TEST(Animation, ParentsCamerasAndLightsMove) {
  GltfBuilder gltf = triangle_scene();
  gltf.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  gltf.root["extensionsUsed"] = {"KHR_lights_punctual"};
  gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  gltf.add_node({{"camera", 0}});
  gltf.add_node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  const int parent = gltf.add_node({{"children", {0, 1, 2}}});
  add_animation(gltf, {{{0, 2}, {0, 0, 0, 2, 0, 0}, "translation", "LINEAR", parent}});
  const LoadedScene loaded = load(gltf, 1.0);
  expect_near(loaded.scene.instances.at(0).world_from_object.column(3), {1, 0, 0});
  expect_near(loaded.scene.cameras.at(0).world_from_camera.column(3), {1, 0, 0});
  expect_near(std::get<PointLight>(loaded.lights.at(0)).position, {1, 0, 0});
}

TEST(Animation, AllPlayTogetherWhereTheyMoveDifferentThings) {
  GltfBuilder gltf = triangle_scene();
  add_animation(gltf, {{{0}, {1, 2, 3}, "translation"}}, "move");
  add_animation(gltf, {{{0}, {4, 4, 4}, "scale"}}, "grow");
  const Mat4f both = placed(gltf, 0.0);
  expect_near(both.column(3), {1, 2, 3});
  expect_near(both.column(0), {4, 0, 0});
  const Mat4f grown = placed(gltf, 0.0, "grow");
  expect_near(grown.column(3), {0, 0, 0});
  expect_near(grown.column(0), {4, 0, 0});
}

TEST(Animation, TheFirstPlaysWhereTheyMoveTheSame) {
  GltfBuilder gltf = triangle_scene();
  add_animation(gltf, {{{0}, {1, 0, 0}, "translation"}}, "walk");
  add_animation(gltf, {{{0}, {2, 0, 0}, "translation"}}, "run");
  expect_near(position(gltf, 0.0), {1, 0, 0});
  expect_near(position(gltf, 0.0, "run"), {2, 0, 0});
  expect_near(position(gltf, 0.0, "1"), {2, 0, 0});
  EXPECT_EQ(load(gltf, 0.0).warnings.size(), 1U);
  const std::string message = error_of([&] { load(gltf, 0.0, "fly"); });
  EXPECT_NE(message.find("none is \"fly\" (expected 0 to 1, or: walk, run)"), std::string::npos) << message;
}

TEST(Animation, WhichThereAreIsSaid) {
  GltfBuilder gltf = triangle_scene();
  const auto message = [&] { return error_of([&] { load(gltf, 0.0, "5"); }); };
  EXPECT_NE(message().find("none is \"5\" (expected none: the file has no animation)"), std::string::npos) << message();
  add_animation(gltf, {{{0}, {1, 0, 0}, "translation"}});
  EXPECT_NE(message().find("none is \"5\" (expected 0)"), std::string::npos) << message();
  add_animation(gltf, {{{0}, {2, 0, 0}, "translation"}}, "run");
  EXPECT_NE(message().find("none is \"5\" (expected 0 to 1, or: run)"), std::string::npos) << message();
}

struct BadAnimation {
  const char* name;
  Channel channel;
  const char* expected;
};

class BadAnimations : public testing::TestWithParam<BadAnimation> {};

TEST_P(BadAnimations, AreRefusedByPlaceWhenPlayed) {
  GltfBuilder gltf = triangle_scene();
  add_animation(gltf, {GetParam().channel});
  EXPECT_EQ(error_of([&] { load(gltf, std::nullopt); }), "");
  const std::string message = error_of([&] { load(gltf, 0.5); });
  EXPECT_NE(message.find("animations[0].channels[0]"), std::string::npos) << message;
  EXPECT_NE(message.find(GetParam().expected), std::string::npos) << message;
}

const BadAnimation kBadAnimations[] = {
    {"TooFewValues", {{0, 1}, {0, 0, 0}, "translation"}, "as many as 2 keys need"},
    {"NoKeys", {{}, {}, "translation"}, "has 0 values"},
    {"CubicWithoutTangents", {{0, 1}, {0, 0, 0, 1, 1, 1}, "translation", "CUBICSPLINE"}, "as many as 2 keys need"},
    {"TimesRunBack", {{1, 0}, {0, 0, 0, 1, 1, 1}, "translation"}, "run back"},
    {"RotationOfNoDirection", {{0, 1}, {0, 0, 0, 1, 0, 0, 0, 0}, "rotation"}, "rotation 1 is of no direction"},
    {"NotANumber", {{0, 1}, {0, 0, 0, NAN, 1, 1}, "translation"}, "not finite"},
    {"UnknownInterpolation", {{0, 1}, {0, 0, 0, 1, 1, 1}, "translation", "BOUNCE"}, "BOUNCE"}};

INSTANTIATE_TEST_SUITE_P(Kinds, BadAnimations, testing::ValuesIn(kBadAnimations), test::kByName);

TEST(Animation, IndicesOfSamplersAreChecked) {
  GltfBuilder gltf = triangle_scene();
  add_animation(gltf, {{{0}, {0, 0, 0}, "translation"}});
  gltf.root["animations"][0]["channels"][0]["sampler"] = 3;
  EXPECT_NE(error_of([&] { load(gltf, std::nullopt); }).find("animations[0].channels[0].sampler: 3 is out of range"),
            std::string::npos);
}

// Morph targets.

GltfBuilder morphing_triangle() {
  GltfBuilder gltf = triangle_scene();
  const int up = gltf.add_accessor<float>({0, 0, 0, 0, 0, 2, 0, 0, 0}, 3, kFloat);
  const int aside = gltf.add_accessor<float>({4, 0, 0, 4, 0, 0, 4, 0, 0}, 3, kFloat);
  gltf.primitive()["targets"] = {{{"POSITION", up}}, {{"POSITION", aside}}};
  return gltf;
}

const std::vector<Vec3f>& shape(const LoadedScene& loaded, std::size_t mesh = 0) {
  return loaded.scene.meshes.at(mesh).positions;
}

TEST(MorphTargets, WeightsOfTheNodeComeBeforeThoseOfTheMesh) {
  GltfBuilder gltf = morphing_triangle();
  EXPECT_EQ(shape(load(gltf, std::nullopt)), (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  gltf.root["meshes"][0]["weights"] = {0.5, 0};
  EXPECT_EQ(shape(load(gltf, std::nullopt)), (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 1}, {0, 1, 0}}));
  gltf.root["nodes"][0]["weights"] = {0, 0.25};
  EXPECT_EQ(shape(load(gltf, std::nullopt)), (std::vector<Vec3f>{{1, 0, 0}, {2, 0, 0}, {1, 1, 0}}));
}

TEST(MorphTargets, AnimatedWeightsShapeTheMesh) {
  GltfBuilder gltf = morphing_triangle();
  add_animation(gltf, {{{0, 1}, {0, 0, 1, 0.5F}, "weights"}});
  EXPECT_EQ(shape(load(gltf, 0.5)), (std::vector<Vec3f>{{1, 0, 0}, {2, 0, 1}, {1, 1, 0}}));
}

TEST(MorphTargets, FlatNormalsAreThoseOfTheShape) {
  GltfBuilder gltf = morphing_triangle();
  gltf.root["meshes"][0]["weights"] = {0.5, 0};
  const float h = std::sqrt(0.5F);
  expect_near(load(gltf, std::nullopt).scene.meshes.at(0).normals.at(0), {-h, 0, h});
}

TEST(MorphTargets, NormalsAreDisplacedToo) {
  GltfBuilder gltf = morphing_triangle();
  gltf.primitive()["attributes"]["NORMAL"] = gltf.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3, kFloat);
  gltf.primitive()["targets"][0]["NORMAL"] = gltf.add_accessor<float>({1, 0, -1, 1, 0, -1, 1, 0, -1}, 3, kFloat);
  gltf.root["meshes"][0]["weights"] = {1, 0};
  expect_near(load(gltf, std::nullopt).scene.meshes.at(0).normals.at(1), {1, 0, 0});
}

TEST(MorphTargets, SparseTargetsMoveOnlyWhatTheyName) {
  GltfBuilder gltf = triangle_scene();
  const int indices = gltf.add_view(bytes_of<std::uint16_t>({2}));
  const int values = gltf.add_view(bytes_of<float>({0, 3, 0}));
  const int target =
      gltf.add_accessor(ordered_json{{"componentType", kFloat},
                                     {"count", 3},
                                     {"type", "VEC3"},
                                     {"sparse",
                                      {{"count", 1},
                                       {"indices", {{"bufferView", indices}, {"componentType", kUnsignedShort}}},
                                       {"values", {{"bufferView", values}}}}}});
  gltf.primitive()["targets"] = {{{"POSITION", target}}};
  gltf.root["meshes"][0]["weights"] = {1};
  EXPECT_EQ(shape(load(gltf, std::nullopt)), (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 4, 0}}));
}

TEST(MorphTargets, NodesOfOtherWeightsHaveMeshesOfTheirOwn) {
  GltfBuilder gltf = morphing_triangle();
  gltf.add_node({{"mesh", 0}, {"weights", {1, 0}}});
  gltf.add_node({{"mesh", 0}, {"translation", {5, 0, 0}}});
  const LoadedScene loaded = load(gltf, std::nullopt);
  EXPECT_EQ(loaded.scene.meshes.size(), 2U);
  EXPECT_EQ(loaded.scene.instances.size(), 3U);
  EXPECT_EQ(shape(loaded, std::size_t(loaded.scene.instances[1].mesh)).at(1), (Vec3f{1, 0, 2}));
  EXPECT_EQ(loaded.scene.instances[2].mesh, loaded.scene.instances[0].mesh);
}

TEST(MorphTargets, OfAnotherNumberOfVerticesAreRefused) {
  GltfBuilder gltf = morphing_triangle();
  gltf.primitive()["targets"][1]["POSITION"] = gltf.add_accessor<float>({4, 0, 0}, 3, kFloat);
  gltf.root["meshes"][0]["weights"] = {0, 1};
  EXPECT_NE(
      error_of([&] { load(gltf, std::nullopt); }).find("meshes[0].primitives[0].targets[1].POSITION: has 1 elements"),
      std::string::npos);
}

TEST(NodeVisibility, HiddenNodesAndTheirChildrenAreLeftOut) {
  GltfBuilder gltf = triangle_scene();
  gltf.add_node({{"mesh", 0}});
  gltf.add_node({{"children", {1}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  gltf.root["extensionsUsed"] = gltf.root["extensionsRequired"] = {"KHR_node_visibility"};
  EXPECT_EQ(load(gltf, std::nullopt).scene.instances.size(), 1U);
}

}  // namespace
}  // namespace chiaro::renderer::tests

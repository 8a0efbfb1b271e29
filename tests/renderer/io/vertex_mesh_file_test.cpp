#include "renderer/io/vertex_mesh_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/core/atomic_file.h"
#include "renderer/io/load_gltf.h"
#include "tests/renderer/io/gltf_builder.h"

namespace chiaro::renderer::tests {
namespace {

using renderer::load_vertex_mesh;
using renderer::save_vertex_mesh;
using renderer::Vec3f;
using renderer::VertexMesh;
using renderer::VertexMeshPart;

VertexMeshPart some_part(const std::string& name, float seed) {
  VertexMeshPart part;
  part.name = name;
  for (int i = 0; i < 5; ++i) {
    const float x = seed + float(i);
    part.positions.push_back({std::sin(x), std::cos(x) / 3, 1e-3F * x});
    part.normals.push_back(normalize(Vec3f{x, 1, -x * x}));
    part.illumination.push_back({1e-6F * x, 1234.567F * x, 0});
    part.weight.push_back(x / 7);
    part.standard_error.push_back(x / 1e5F);
  }
  part.triangles = {{0, 1, 2}, {2, 3, 4}, {4, 4, 0}};
  return part;
}

TEST(VertexMeshFile, EverythingComesBackBitByBit) {
  const TemporaryFolder folder;
  VertexMesh mesh{{some_part("floor", 0.1F), some_part("wall", 2.3F)}};
  mesh.parts[1].weight.clear();
  mesh.parts[1].standard_error.clear();
  for (const char* name : {"mesh.glb", "mesh.gltf"}) {
    save_vertex_mesh(mesh, folder / name, 100);
    const VertexMesh loaded = load_vertex_mesh(folder / name);
    ASSERT_EQ(loaded.parts.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(loaded.parts[i].name, mesh.parts[i].name);
      EXPECT_EQ(loaded.parts[i].positions, mesh.parts[i].positions);
      EXPECT_EQ(loaded.parts[i].normals, mesh.parts[i].normals);
      EXPECT_EQ(loaded.parts[i].triangles, mesh.parts[i].triangles);
      EXPECT_EQ(loaded.parts[i].illumination, mesh.parts[i].illumination);
      EXPECT_EQ(loaded.parts[i].weight, mesh.parts[i].weight);
      EXPECT_EQ(loaded.parts[i].standard_error, mesh.parts[i].standard_error);
    }
  }
  EXPECT_EQ(renderer::read_file(folder / "mesh.gltf").front(), '{') << "text, as its name says";
}

TEST(VertexMeshFile, IlluminationIsShownAsClampedColour) {
  const TemporaryFolder folder;
  VertexMesh mesh{{some_part("floor", 1)}};
  mesh.parts[0].illumination = {{0, 50, 100}, {25, 200, 1}, {}, {}, {}};
  save_vertex_mesh(mesh, folder / "mesh.glb", 100);
  const VertexMesh loaded = load_vertex_mesh(folder / "mesh.glb");
  const std::vector<Vec3f>& color = loaded.parts.at(0).color;
  ASSERT_EQ(color.size(), 5U);
  EXPECT_NEAR(color[0].y, 0.5F, 1e-5F);
  EXPECT_EQ(color[0].z, 1);
  EXPECT_NEAR(color[1].x, 0.25F, 1e-5F);
  EXPECT_EQ(color[1].y, 1);
}

TEST(VertexMeshFile, NodesMoveVerticesAndMissingNormalsAreMade) {
  const TemporaryFolder folder;
  GltfBuilder gltf = triangle_scene();
  gltf.root["nodes"][0] = {{"mesh", 0}, {"name", "up"}, {"translation", {0, 0, 5}}, {"scale", {-2, 1, 1}}};
  const VertexMesh mesh = load_vertex_mesh(folder.write("mesh.glb", gltf.glb()));
  ASSERT_EQ(mesh.parts.size(), 1U);
  EXPECT_EQ(mesh.parts[0].name, "up");
  EXPECT_EQ(mesh.parts[0].positions, (std::vector<Vec3f>{{0, 0, 5}, {-2, 0, 5}, {0, 1, 5}}));
  EXPECT_TRUE(mesh.parts[0].illumination.empty());
  for (const Vec3f& normal : mesh.parts[0].normals) EXPECT_EQ(normal, (Vec3f{0, 0, 1})) << "still the outside";
}

std::vector<std::vector<Vec3f>> places_in_scene(const std::filesystem::path& path) {
  const Scene scene = load_gltf(path).scene;
  std::vector<std::vector<Vec3f>> places;
  for (const Instance& instance : scene.instances) {
    places.emplace_back();
    for (const Vec3f p : scene.meshes[std::size_t(instance.mesh)].positions) {
      places.back().push_back(transform_point(instance.world_from_object, p));
    }
  }
  return places;
}

std::vector<std::vector<Vec3f>> places_in_mesh(const std::filesystem::path& path) {
  std::vector<std::vector<Vec3f>> places;
  for (const VertexMeshPart& part : load_vertex_mesh(path).parts) places.push_back(part.positions);
  return places;
}

// Both readers find it there.
void expect_places(const GltfBuilder& gltf, const std::vector<std::vector<Vec3f>>& places) {
  const TemporaryFolder folder;
  const auto path = folder.write("mesh.glb", gltf.glb());
  EXPECT_EQ(places_in_mesh(path), places);
  EXPECT_EQ(places_in_scene(path), places);
}

// The triangle's corners in the order of joints 0, 1, 1; the joints stand at z = 2 and z = 5.
GltfBuilder skinned_triangle() {
  GltfBuilder gltf = triangle_scene();
  gltf.primitive()["attributes"]["JOINTS_0"] =
      gltf.add_accessor<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 4, kUnsignedByte);
  gltf.primitive()["attributes"]["WEIGHTS_0"] =
      gltf.add_accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 4, kFloat);
  gltf.add_node({{"translation", {0, 0, 2}}});
  gltf.add_node({{"translation", {0, 0, 5}}});
  gltf.root["skins"] = {{{"joints", {1, 2}}}};
  gltf.root["nodes"][0]["skin"] = 0;
  gltf.root["nodes"][0]["translation"] = {100, 0, 0};
  return gltf;
}

GltfBuilder instanced_triangle(const std::string& attribute, const std::vector<float>& values) {
  GltfBuilder gltf = triangle_scene();
  const int accessor = gltf.add_accessor(values, 3, kFloat);
  gltf.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"][attribute] = accessor;
  gltf.root["extensionsUsed"] = gltf.root["extensionsRequired"] = ordered_json::array({"EXT_mesh_gpu_instancing"});
  return gltf;
}

TEST(VertexMeshFile, EachInstanceIsAPartWithTheValuesOfTheMesh) {
  GltfBuilder gltf = instanced_triangle("TRANSLATION", {0, 0, 0, 0, 5, 0});
  gltf.root["nodes"][0]["scale"] = {2, 2, 2};
  gltf.primitive()["attributes"]["_ILLUMINATION"] = gltf.add_accessor<float>({1, 2, 3, 4, 5, 6, 7, 8, 9}, 3, kFloat);
  expect_places(gltf, {{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, {{0, 10, 0}, {2, 10, 0}, {0, 12, 0}}});
  const TemporaryFolder folder;
  for (const VertexMeshPart& part : load_vertex_mesh(folder.write("mesh.glb", gltf.glb())).parts) {
    EXPECT_EQ(part.illumination, (std::vector<Vec3f>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
  }
}

TEST(VertexMeshFile, InstancesOfMoreVerticesThanMemoryHoldsAreRefused) {
  constexpr std::size_t kMany = 6000;
  GltfBuilder gltf = instanced_triangle("TRANSLATION", std::vector<float>(3 * kMany, 0.0F));
  std::vector<float> positions(3 * kMany);
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = float(i * i % 17);
  gltf.primitive()["attributes"]["POSITION"] = gltf.add_accessor(positions, 3, kFloat);
  gltf.primitive().erase("indices");
  const TemporaryFolder folder;
  const auto path = folder.write("mesh.glb", gltf.glb());
  const std::string message = error_of([&] { load_vertex_mesh(path); });
  EXPECT_NE(message.find("nodes[0]: its 6000 instances have 3.6e+07 vertices together"), std::string::npos) << message;
}

TEST(VertexMeshFile, MirroredInstancesKeepTheirOutside) {
  const TemporaryFolder folder;
  const GltfBuilder gltf = instanced_triangle("SCALE", {1, 1, 1, -1, 1, 1});
  const VertexMesh mesh = load_vertex_mesh(folder.write("mesh.glb", gltf.glb()));
  ASSERT_EQ(mesh.parts.size(), 2U);
  EXPECT_NE(mesh.parts[0].triangles, mesh.parts[1].triangles);
  for (const VertexMeshPart& part : mesh.parts) EXPECT_EQ(part.normals.at(0), (Vec3f{0, 0, 1}));
}

TEST(VertexMeshFile, InstancesScaledToNothingAreLeftOut) {
  expect_places(instanced_triangle("SCALE", {0, 0, 0, 1, 1, 1}), {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
}

TEST(VertexMeshFile, SkinsMoveVerticesInPlaceOfTheNode) {
  expect_places(skinned_triangle(), {{{0, 0, 2}, {1, 0, 5}, {0, 1, 5}}});
}

TEST(VertexMeshFile, ASkinOfAMeshWithoutJointsMovesNothing) {
  GltfBuilder gltf = skinned_triangle();
  gltf.primitive()["attributes"].erase("JOINTS_0");
  gltf.primitive()["attributes"].erase("WEIGHTS_0");
  expect_places(gltf, {{{100, 0, 0}, {101, 0, 0}, {100, 1, 0}}});
}

TEST(VertexMeshFile, MorphTargetsCountByTheirWeights) {
  GltfBuilder gltf = triangle_scene();
  const int moves = gltf.add_accessor<float>({0, 0, 0, 0, 0, 0, 0, 8, 0}, 3, kFloat);
  gltf.primitive()["targets"] = ordered_json::array({{{"POSITION", moves}}});
  gltf.root["meshes"][0]["weights"] = {0.5};
  expect_places(gltf, {{{0, 0, 0}, {1, 0, 0}, {0, 5, 0}}});
  gltf.root["nodes"][0]["weights"] = {0.25};
  expect_places(gltf, {{{0, 0, 0}, {1, 0, 0}, {0, 3, 0}}});
}

TEST(VertexMeshFile, HiddenNodesAreLeftOut) {
  GltfBuilder gltf = triangle_scene();
  gltf.add_node({{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  expect_places(gltf, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
}

TEST(VertexMeshFile, PointsAndLinesAreNotRead) {
  GltfBuilder gltf = triangle_scene();
  for (const int mode : {0, 1, 3}) {
    const int positions = gltf.add_accessor<float>({9, 9, 9, 8, 8, 8, 7, 7, 7}, 3, kFloat);
    const int values = gltf.add_accessor<std::uint32_t>({0, 1, 2, 3, 4, 5, 6, 7, 8}, 3, kUnsignedInt);
    const int mesh = gltf.add_mesh({{"POSITION", positions}, {"_ILLUMINATION", values}});
    gltf.primitive(mesh)["mode"] = mode;
    gltf.add_node({{"mesh", mesh}});
  }
  expect_places(gltf, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
}

TEST(VertexMeshFile, VerticesThatNoTriangleUsesAreNotRead) {
  GltfBuilder gltf;
  const int positions = gltf.add_accessor<float>({0, 0, 0, 1, 0, 0, 1e30F, 0, 0, 0, 1, 0, 9, 9, 9}, 3, kFloat);
  const int normals = gltf.add_accessor<float>({0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0}, 3, kFloat);
  const int values = gltf.add_accessor<float>({1, 1, 1, 2, 2, 2, 500, 0, 0, 4, 4, 4, 500, 0, 0}, 3, kFloat);
  const int weights = gltf.add_accessor<float>({1, 2, 3, 4, 5}, 1, kFloat);
  gltf.add_mesh({{"POSITION", positions}, {"NORMAL", normals}, {"_ILLUMINATION", values}, {"COLOR_0", values}});
  for (const char* name : {"_WEIGHT", "_STANDARD_ERROR"}) gltf.primitive()["attributes"][name] = weights;
  gltf.primitive()["indices"] = gltf.add_accessor<std::uint32_t>({0, 1, 3}, 1, kUnsignedInt);
  gltf.add_node({{"mesh", 0}});
  const TemporaryFolder folder;
  const VertexMesh mesh = load_vertex_mesh(folder.write("mesh.glb", gltf.glb()));
  ASSERT_EQ(mesh.parts.size(), 1U);
  const VertexMeshPart& part = mesh.parts[0];
  const std::vector<Vec3f> used_values{{1, 1, 1}, {2, 2, 2}, {4, 4, 4}};
  EXPECT_EQ(part.positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(part.normals, (std::vector<Vec3f>{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}));
  EXPECT_EQ(part.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(part.illumination, used_values);
  EXPECT_EQ(part.color, used_values);
  EXPECT_EQ(part.weight, (std::vector<float>{1, 2, 4}));
  EXPECT_EQ(part.standard_error, part.weight);
}

TEST(VertexMeshFile, WhatItsExtensionsWouldChangeIsSaid) {
  const TemporaryFolder folder;
  GltfBuilder gltf = triangle_scene();
  EXPECT_TRUE(load_vertex_mesh(folder.write("mesh.glb", gltf.glb())).warnings.empty());
  gltf.root["extensionsUsed"] = {"EXT_of_nobody"};
  const VertexMesh mesh = load_vertex_mesh(folder.write("mesh.glb", gltf.glb()));
  ASSERT_EQ(mesh.warnings.size(), 1U);
  EXPECT_NE(mesh.warnings[0].find("EXT_of_nobody"), std::string::npos) << mesh.warnings[0];
}

TEST(VertexMeshFile, LinearColourOfOtherProgramsIsRead) {
  const TemporaryFolder folder;
  GltfBuilder gltf = triangle_scene();
  gltf.primitive()["attributes"]["COLOR_0"] = gltf.add_accessor<float>({1, 2, 3, 4, 5, 6, 7, 8, 9}, 3, kFloat);
  const VertexMesh mesh = load_vertex_mesh(folder.write("mesh.glb", gltf.glb()));
  EXPECT_EQ(mesh.parts.at(0).color, (std::vector<Vec3f>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
}

TEST(VertexMeshFile, BadAttributesAreRefused) {
  const TemporaryFolder folder;
  const auto message_with = [&](const char* name, const std::vector<float>& values, int components) {
    GltfBuilder gltf = triangle_scene();
    gltf.primitive()["attributes"][name] = gltf.add_accessor(values, components, kFloat);
    const auto path = folder.write("mesh.glb", gltf.glb());
    return error_of([&] { load_vertex_mesh(path); });
  };
  const float nan = std::nanf("");
  EXPECT_EQ(message_with("_WEIGHT", {0, 1, 2}, 1), "");
  EXPECT_NE(message_with("_WEIGHT", {0, 1, -2}, 1).find("_WEIGHT: vertex 2"), std::string::npos);
  EXPECT_NE(message_with("_WEIGHT", {0, nan, 2}, 1).find("_WEIGHT: vertex 1"), std::string::npos);
  EXPECT_NE(message_with("_WEIGHT", {0, 1}, 1).find("has 2 elements"), std::string::npos);
  EXPECT_NE(message_with("_ILLUMINATION", {0, 1, 2}, 1).find("_ILLUMINATION"), std::string::npos);
  EXPECT_NE(message_with("_ILLUMINATION", {0, 1, 2, nan, 0, 0, 0, 0, 0}, 3).find("vertex 1 is not finite"),
            std::string::npos);
}

TEST(VertexMeshFile, VerticesBeyondTheWorldAreRefused) {
  const TemporaryFolder folder;
  for (const float far : {1.1e9F, 1e30F}) {
    GltfBuilder gltf = triangle_scene();
    gltf.primitive()["attributes"]["POSITION"] = gltf.add_accessor<float>({0, 0, 0, far, 0, 0, 0, 1, 0}, 3, kFloat);
    const auto path = folder.write("mesh.glb", gltf.glb());
    EXPECT_NE(error_of([&] { load_vertex_mesh(path); }).find("nodes[0]: puts a vertex at"), std::string::npos) << far;
  }
}

TEST(VertexMeshFile, IntegerIlluminationIsOfTheWrongKind) {
  const TemporaryFolder folder;
  GltfBuilder gltf = triangle_scene();
  gltf.primitive()["attributes"]["_ILLUMINATION"] =
      gltf.add_accessor<std::uint32_t>({0, 1, 2, 3, 4, 5, 6, 7, 8}, 3, kUnsignedInt);
  const auto path = folder.write("mesh.glb", gltf.glb());
  EXPECT_NE(error_of([&] { load_vertex_mesh(path); }).find("not of floats"), std::string::npos);
}

TEST(VertexMeshFile, AFileWithoutTrianglesIsRefused) {
  const TemporaryFolder folder;
  save_vertex_mesh({}, folder / "empty.glb", 1);
  GltfBuilder points = triangle_scene();
  points.primitive()["mode"] = 0;
  folder.write("points.glb", points.glb());
  for (const char* name : {"empty.glb", "points.glb"}) {
    const std::string message = error_of([&] { load_vertex_mesh(folder / name); });
    EXPECT_NE(message.find("meshes: no node shows any triangles"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace chiaro::renderer::tests

#include "renderer/io/vertex_mesh_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/core/atomic_file.h"
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

TEST(VertexMeshFile, AFileWithoutVerticesIsRefused) {
  const TemporaryFolder folder;
  save_vertex_mesh({}, folder / "empty.glb", 1);
  EXPECT_NE(error_of([&] { load_vertex_mesh(folder / "empty.glb"); }).find("no node shows"), std::string::npos);
}

}  // namespace
}  // namespace chiaro::renderer::tests

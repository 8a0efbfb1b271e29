#include "inverse/target/lightmap.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "inverse/target/texel_coverage.h"
#include "renderer/core/error.h"
#include "tests/support/code_scenes.h"

namespace chiaro::inverse {
namespace {

using renderer::Mesh;
using renderer::Scene;

// u along the rectangle's first side, v along its second.
Mesh unfolded_rectangle(Vec3f corner, Vec3f u, Vec3f v, int n, int uv_set) {
  Mesh mesh = test::rectangle(corner, u, v, n);
  for (const Vec3f p : mesh.positions) {
    mesh.uv[std::size_t(uv_set)].push_back({dot(p - corner, u) / dot(u, u), dot(p - corner, v) / dot(v, v)});
  }
  return mesh;
}

// 4 m along z, 2 m along x, facing up.
Scene floor_scene(int n = 1, int uv_set = 0) {
  Scene scene;
  scene.path = "floor.glb";
  test::add_mesh(scene, unfolded_rectangle({0, 0, 0}, {0, 0, 4}, {2, 0, 0}, n, uv_set),
                 test::lambert({0.5F, 0.5F, 0.5F}), "floor");
  return scene;
}

// The red of texel (x, y) is 10 y + x.
Lightmap numbered_map(int width, int height) {
  Lightmap map;
  map.node = "floor";
  map.width = width;
  map.height = height;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) map.texels.push_back({float(10 * y + x), 1, 2});
  }
  map.weight.assign(map.texels.size(), 1);
  return map;
}

TEST(Lightmap, PutsTexelsWhereTheyLieOnTheSurface) {
  const LightmapValues read = values_of_lightmap(floor_scene(3), numbered_map(8, 4));
  ASSERT_EQ(read.values.size(), 32U);
  EXPECT_EQ(read.counts.used, 32U);
  EXPECT_NEAR(read.area, 8, 1e-5);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) {
      const SurfaceValue& value = read.values[std::size_t(8 * y + x)];
      EXPECT_NEAR(value.position.z, 0.5F * (float(x) + 0.5F), 1e-5F);
      EXPECT_NEAR(value.position.x, 0.5F * (float(y) + 0.5F), 1e-5F) << "v runs down";
      EXPECT_EQ(value.illumination, (Vec3f{float(10 * y + x), 1, 2}));
      EXPECT_NEAR(value.normal.y, 1, 1e-6F);
      EXPECT_NEAR(value.weight, 0.25F, 1e-5F) << "a texel is half a metre wide";
    }
  }
}

TEST(Lightmap, OfANodeThatIsScaledAndMirrored) {
  Scene scene = floor_scene();
  scene.instances[0].world_from_object = renderer::make_transform({1, 2, 3}, {0, 0, 0, 1}, {-3, 1, 2});
  const LightmapValues read = values_of_lightmap(scene, numbered_map(4, 2));
  EXPECT_NEAR(read.area, 48, 1e-4);
  EXPECT_NEAR(read.values[0].position.x, 1 - 3 * 0.5F, 1e-5F);
  EXPECT_NEAR(read.values[0].position.y, 2, 1e-6F);
  EXPECT_NEAR(read.values[0].position.z, 3 + 2 * 0.5F, 1e-5F);
  EXPECT_NEAR(read.values[0].normal.y, 1, 1e-6F) << "the side of the vertex normals";
}

TEST(Lightmap, ShowsEveryCopyOfItsNode) {
  Scene scene = floor_scene();
  scene.instances.push_back(scene.instances[0]);
  scene.instances[1].world_from_object = renderer::make_transform({0, 5, 0}, {0, 0, 0, 1}, {1, 1, 1});
  const LightmapValues read = values_of_lightmap(scene, numbered_map(4, 2));
  EXPECT_EQ(read.copies, 2U);
  EXPECT_EQ(read.counts.used, 8U);
  ASSERT_EQ(read.values.size(), 16U);
  EXPECT_EQ(read.values[1].position.y, 5);
  EXPECT_EQ(read.counts.overlapping, 0U);
}

TEST(Lightmap, TakesTheSecondSetOfCoordinatesWhereThereIsOne) {
  Scene scene = floor_scene(1, 1);
  scene.meshes[0].uv[0].assign(4, {0.25F, 0.25F});
  EXPECT_EQ(values_of_lightmap(scene, numbered_map(4, 2)).uv_set, 1);
  EXPECT_EQ(values_of_lightmap(floor_scene(1, 0), numbered_map(4, 2)).uv_set, 0);
  Lightmap map = numbered_map(4, 2);
  map.uv_set = 0;
  const LightmapValues read = values_of_lightmap(scene, map);
  EXPECT_EQ(read.uv_set, 0);
  EXPECT_EQ(read.counts.used, 0U) << "its triangles have no area there";
}

TEST(Lightmap, NamesTheNodesAndCoordinatesThatThereAre) {
  Lightmap map = numbered_map(2, 2);
  map.uv_set = 3;
  try {
    values_of_lightmap(floor_scene(), map);
    FAIL();
  } catch (const renderer::Error& error) {
    EXPECT_STREQ(error.what(),
                 "floor.glb: node 'floor': has no TEXCOORD_3 all over (expected --lightmap-uv for one of: TEXCOORD_0)");
  }
  map.node = "flor";
  try {
    values_of_lightmap(floor_scene(), map);
    FAIL();
  } catch (const renderer::Error& error) {
    EXPECT_STREQ(error.what(), "floor.glb: nodes: no node 'flor' that shows a mesh (expected one of: floor)");
  }
}

TEST(Lightmap, LeavesOutMaskedInvalidAndEmptyTexels) {
  Scene scene = floor_scene();
  for (renderer::Vec2f& uv : scene.meshes[0].uv[0]) uv = 0.5F * uv;  // of 8 × 4 texels the upper left 4 × 2
  Lightmap map = numbered_map(8, 4);
  map.weight[0] = 0;
  map.weight[1] = 0.25F;
  map.texels[2] = {-1, 0, 0};
  map.texels[3] = {0, std::numeric_limits<float>::quiet_NaN(), 0};
  map.texels[8] = {0, 0, 1e30F};
  map.texels[31] = map.texels[3];
  const LightmapValues read = values_of_lightmap(scene, map);
  EXPECT_EQ(read.counts.empty, 24U);
  EXPECT_EQ(read.counts.masked, 1U);
  EXPECT_EQ(read.counts.invalid, 3U);
  EXPECT_EQ(read.counts.used, 4U);
  EXPECT_NEAR(read.values[0].weight, 0.25F, 1e-5F) << "a quarter of a square metre";
  EXPECT_NEAR(read.values[1].weight, 1, 1e-5F);
}

TEST(Lightmap, LeavesOutWhatOverlapsOrLeavesThePicture) {
  Scene scene = floor_scene();
  Mesh& mesh = scene.meshes[0];
  mesh.triangles.push_back(mesh.triangles[0]);
  LightmapValues read = values_of_lightmap(scene, numbered_map(16, 16));
  EXPECT_EQ(read.counts.overlapping, 120U) << "half of the texels but for those on the diagonal";
  EXPECT_EQ(read.counts.used, 136U);
  for (renderer::Vec2f& uv : mesh.uv[0]) uv = uv + renderer::Vec2f{0, uv.x > 0.5F && uv.y > 0.5F ? 1.0F : 0.0F};
  read = values_of_lightmap(scene, numbered_map(16, 16));
  EXPECT_EQ(read.triangles_outside, 3U);
  EXPECT_EQ(read.counts.used, 0U);
}

// Rounding leaves triangles that are laid out as lines a little area, by which their texels would stand for thousands
// of square metres.
TEST(Lightmap, LeavesOutTrianglesThatAreLinesButForRounding) {
  Scene scene = floor_scene();
  Mesh& mesh = scene.meshes[0];
  const LightmapValues whole = values_of_lightmap(scene, numbered_map(16, 16));
  for (int k = 0; k < 3; ++k) {
    mesh.triangles.push_back(mesh.triangles[0]);
    for (int c = 0; c < 3; ++c) mesh.triangles.back()[c] = std::uint32_t(mesh.positions.size()) + std::uint32_t(c);
    for (int c = 0; c < 3; ++c) {
      mesh.positions.push_back(mesh.positions[std::size_t(c)]);
      mesh.normals.push_back(mesh.normals[std::size_t(c)]);
      mesh.uv[0].push_back({0.1F + 0.4F * float(c), 0.5F / 16 + (c == 1 ? 1e-6F * float(k) : 0)});
    }
  }
  const LightmapValues read = values_of_lightmap(scene, numbered_map(16, 16));
  EXPECT_FLOAT_EQ(float(read.area), float(whole.area));
  EXPECT_EQ(read.counts.used, whole.counts.used);
}

// What is linear on the surface comes back at its receivers.
TEST(Lightmap, BringsALinearFieldToTheReceivers) {
  const Scene scene = floor_scene(4);
  Lightmap map = numbered_map(64, 32);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x)
      map.texels[std::size_t(64 * y + x)] = {(float(x) + 0.5F) / 64, (float(y) + 0.5F) / 32, 1};
  }
  const Receivers receivers = make_receivers(scene, {.max_edge = 0.5F});
  const TargetFromValues result = target_from_values(receivers, values_of_lightmap(scene, map).values);
  EXPECT_EQ(result.not_placed, 0U);
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const Vec3f at = result.target.receivers.samples[i].position;
    EXPECT_NEAR(result.target.illumination[i].x, at.z / 4, 0.01F);
    EXPECT_NEAR(result.target.illumination[i].y, at.x / 2, 0.02F);
  }
}

// Triangles that share edges, in any direction, share no texel, and leave none out.
TEST(TexelCoverage, OfATriangulationTakesEveryTexelOnce) {
  Scene scene = floor_scene(7);
  for (renderer::Vec2f& uv : scene.meshes[0].uv[0]) {
    const float x = uv.x, y = uv.y, bend = 0.2F * x * (1 - x) * y * (1 - y);
    uv = {x + bend * std::sin(9 * y), y + bend * std::cos(7 * x)};
  }
  const std::array<int, 1> meshes{0};
  const TexelCoverage coverage = cover_texels(scene, meshes, {.width = 37, .height = 53});
  ASSERT_EQ(coverage.texels.size(), 37U * 53U);
  for (const TexelCover& texel : coverage.texels) {
    EXPECT_EQ(texel.mesh, 0);
    EXPECT_FALSE(texel.overlapping);
  }
}

}  // namespace
}  // namespace chiaro::inverse

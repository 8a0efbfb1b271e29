#include "renderer/scene/material_override.h"

#include <gtest/gtest.h>

#include "renderer/trace/render.h"
#include "tests/support/code_scenes.h"

namespace chiaro::renderer {
namespace {

TEST(MaterialOverride, DiffuseFiltersTexturesAsStoredAndEndsLightAtTheTrianglesHorizon) {
  Scene scene;
  scene.materials.emplace_back();
  scene.textures.push_back({"", 1, 1, {0, 0, 0, 255}});
  const Scene same = with_materials(scene, {});
  EXPECT_FALSE(same.textures[0].filtered_as_stored);
  EXPECT_FALSE(same.materials[0].geometric_horizon);
  const Scene diffuse = with_materials(scene, {.model = MaterialModel::kDiffuse, .albedo = {}});
  EXPECT_TRUE(diffuse.textures[0].filtered_as_stored);
  EXPECT_TRUE(diffuse.materials[0].geometric_horizon);
}

TEST(MaterialOverride, WhatEmitsStaysLitAndReflectsAsTheOverrideSays) {
  Scene scene;
  Material lamp;
  lamp.emission = {4, 2, 1};
  lamp.emission_texture.texture = 0;
  scene.textures.push_back({"", 1, 1, {255, 255, 0, 255}});
  lamp.layers.emplace();
  test::add_mesh(scene, test::rectangle({-1, -1, -2}, {2, 0, 0}, {0, 2, 0}), lamp, "lamp");
  scene.meshes[0].uv[0].assign(scene.meshes[0].positions.size(), {0, 0});
  const MaterialOverride overrides[] = {{.model = MaterialModel::kDiffuse, .albedo = {}},
                                        {.model = MaterialModel::kGltf, .albedo = Vec3f{0.5F, 0.5F, 0.5F}}};
  for (const MaterialOverride& materials : overrides) {
    const Scene overridden = with_materials(scene, materials);
    const float albedo = materials.albedo ? 0.5F : 1;
    const RayTracer tracer(overridden);
    RenderOptions options;
    options.width = options.height = 4;
    options.trace = {.samples = 4, .bounces = 0};
    const Lights sun{DirectionalLight{"", {0, 0, -1}, {kPi, kPi, kPi}}};
    const Image image = render(tracer, {}, sun, options).image;
    EXPECT_NEAR(image.at(2, 2)[0], 4 + albedo, 1e-4F);
    EXPECT_NEAR(image.at(2, 2)[1], 2 + albedo, 1e-4F);
    EXPECT_NEAR(image.at(2, 2)[2], albedo, 1e-4F);
  }
}

TEST(MaterialOverride, HidesBacksOfSingleSidedSurfacesThatDoNotTransmit) {
  Scene scene;
  scene.materials.resize(3);
  scene.materials[1].double_sided = true;
  scene.materials[2].layers.emplace();
  scene.materials[2].layers->transmission = 1;
  for (const MaterialModel model : {MaterialModel::kGltf, MaterialModel::kDiffuse}) {
    const Scene hidden = with_materials(scene, {.model = model, .albedo = {}, .hide_backs = true});
    EXPECT_TRUE(hidden.materials[0].hidden_back);
    EXPECT_FALSE(hidden.materials[1].hidden_back);
    EXPECT_FALSE(hidden.materials[2].hidden_back);
  }
  EXPECT_FALSE(with_materials(scene, {}).materials[0].hidden_back);
}

TEST(MaterialOverride, GeometricHorizonKeepsLightFromBelowTheTriangleOut) {
  // A triangle whose vertex normals lean by 45° towards a light that stands 10° below its plane.
  const auto seen = [](bool geometric_horizon) {
    Scene scene;
    Material material = test::lambert({1, 1, 1});
    material.geometric_horizon = geometric_horizon;
    test::add_mesh(scene, test::rectangle({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), material, "plane");
    for (Vec3f& n : scene.meshes[0].normals) n = normalize(Vec3f{1, 1, 0});
    const RayTracer tracer(scene);
    const Vec3f to_light = normalize(Vec3f{1, -std::tan(10 * kPi / 180), 0});
    Camera camera;
    camera.world_from_camera = Mat4f{};
    const Vec3f columns[4] = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {0.5F, 3, 0}};
    for (int c = 0; c < 4; ++c) {
      for (int row = 0; row < 3; ++row) camera.world_from_camera(row, c) = columns[c][row];
    }
    camera.vertical_fov = 0.1F;
    RenderOptions options;
    options.width = options.height = 4;
    options.trace = {.samples = 4, .bounces = 0};
    const Image image = render(tracer, camera, {DirectionalLight{"", -to_light, {100, 100, 100}}}, options).image;
    return image.at(2, 2)[0];
  };
  EXPECT_GT(seen(false), 1);
  EXPECT_EQ(seen(true), 0);
}

}  // namespace
}  // namespace chiaro::renderer

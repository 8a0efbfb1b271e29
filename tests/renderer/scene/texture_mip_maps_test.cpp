#include "renderer/scene/texture_mip_maps.h"

#include <gtest/gtest.h>

#include "renderer/image/mip_maps.h"
#include "tests/support/code_scenes.h"

namespace chiaro::renderer {
namespace {

// Half white and opaque, half black and clear.
Texture half_and_half() { return {"", 2, 1, {255, 255, 255, 255, 0, 0, 0, 0}}; }

std::uint8_t mean_red(const Scene& scene, const TextureUse& use) {
  return scene.textures[std::size_t(use.texture)].mips.back()[0];
}

Scene scene_of(const std::vector<Material>& materials, Texture texture = half_and_half()) {
  Scene scene;
  for (const Material& material : materials) {
    test::add_mesh(scene, test::rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), material, "quad");
  }
  scene.textures.push_back(std::move(texture));
  return scene;
}

Material textured(AlphaMode mode) {
  Material material = test::lambert({1, 1, 1});
  material.lambert = false;
  material.alpha_mode = mode;
  material.base_color_texture.texture = 0;
  return material;
}

TEST(TextureMipMaps, EveryWayToUseATextureHasItsOwn) {
  Material data = textured(AlphaMode::kOpaque);
  data.base_color_texture.texture = -1;
  data.metallic_roughness_texture.texture = 0;
  Scene scene = scene_of({textured(AlphaMode::kBlend), textured(AlphaMode::kOpaque), data});
  make_mip_maps(scene);
  EXPECT_EQ(mean_red(scene, scene.materials[0].base_color_texture), 255);  // what is not there has no say
  EXPECT_EQ(mean_red(scene, scene.materials[1].base_color_texture), 188);  // half the light, as sRGB
  EXPECT_NEAR(mean_red(scene, scene.materials[2].metallic_roughness_texture), 127.5, 0.6);
  EXPECT_EQ(scene.textures.size(), 3U);
}

TEST(TextureMipMaps, EmissionIsWide) {
  Material glowing = textured(AlphaMode::kOpaque);
  glowing.emission_texture.texture = 0;
  Scene scene = scene_of({glowing});
  make_mip_maps(scene);
  EXPECT_TRUE(is_wide(scene.textures[std::size_t(scene.materials[0].emission_texture.texture)]));
  EXPECT_FALSE(is_wide(scene.textures[std::size_t(scene.materials[0].base_color_texture.texture)]));
}

TEST(TextureMipMaps, TexturesOfOneUseAreNotCopied) {
  Texture opaque = half_and_half();
  opaque.rgba[7] = 255;
  Scene scene = scene_of({textured(AlphaMode::kBlend), textured(AlphaMode::kOpaque)}, opaque);
  make_mip_maps(scene);
  EXPECT_EQ(scene.textures.size(), 1U);
  EXPECT_TRUE(has_mips(scene.textures[0]));
}

}  // namespace
}  // namespace chiaro::renderer

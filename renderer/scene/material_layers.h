#pragma once
// What the KHR_materials_* extensions add to metallic-roughness. Factors are multiplied with their textures.

#include "renderer/core/vec.h"
#include "renderer/scene/texture_use.h"

namespace chiaro::renderer {

struct MaterialLayers {
  // KHR_materials_ior: ≥ 1, or 0 for a dielectric that reflects everything.
  float ior = 1.5F;

  // KHR_materials_specular
  float specular = 1;
  TextureUse specular_texture;        // A; linear
  Vec3f specular_color{1, 1, 1};      // may exceed 1
  TextureUse specular_color_texture;  // sRGB

  // KHR_materials_transmission
  float transmission = 0;
  TextureUse transmission_texture;  // R; linear

  // KHR_materials_volume. Solid: the mesh bounds a volume that refracts and absorbs; else it is a thin sheet.
  bool solid = false;
  Vec3f absorption;  // 1 / metres of the world

  // KHR_materials_clearcoat
  float clearcoat = 0;
  TextureUse clearcoat_texture;  // R; linear
  float clearcoat_roughness = 0;
  TextureUse clearcoat_roughness_texture;  // G; linear
  TextureUse clearcoat_normal_texture;     // linear
  float clearcoat_normal_scale = 1;

  // KHR_materials_sheen
  Vec3f sheen_color;
  TextureUse sheen_color_texture;  // sRGB
  float sheen_roughness = 0;
  TextureUse sheen_roughness_texture;  // A; linear
};

}  // namespace chiaro::renderer

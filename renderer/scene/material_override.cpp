#include "renderer/scene/material_override.h"

namespace chiaro::renderer {
namespace {

void make_diffuse(Material& material) {
  material.lambert = true;
  material.geometric_horizon = true;
  material.metallic = 0;
  material.roughness = 1;
  material.metallic_roughness_texture = {};
  material.normal_texture = {};
  material.unlit = false;
  material.layers.reset();
}

bool transmits(const Material& material) { return material.layers && material.layers->transmission > 0; }

// Alpha needs the base colour's texture, so a constant albedo keeps the texture only where alpha is used.
void set_albedo(Material& material, Vec3f albedo) {
  material.base_color = albedo;
  material.constant_base_color = true;
}

}  // namespace

Scene with_materials(Scene scene, const MaterialOverride& materials) {
  for (Material& material : scene.materials) {
    material.hidden_back = materials.hide_backs && !material.double_sided && !transmits(material);
  }
  if (materials.model == MaterialModel::kGltf && !materials.albedo) return scene;
  for (Material& material : scene.materials) {
    make_diffuse(material);
    if (materials.albedo) set_albedo(material, *materials.albedo);
  }
  for (Texture& texture : scene.textures) texture.filtered_as_stored = true;
  return scene;
}

}  // namespace chiaro::renderer

#include "renderer/io/missing_coordinates.h"

#include <set>

#include <fmt/format.h>

#include "renderer/core/shortened.h"

namespace chiaro::renderer {
namespace {

struct NamedUse {
  const char* name;  // as glTF has it
  const TextureUse* use;
};

std::vector<NamedUse> uses_of(const Material& m) {
  return {{"baseColorTexture", &m.base_color_texture},
          {"metallicRoughnessTexture", &m.metallic_roughness_texture},
          {"normalTexture", &m.normal_texture},
          {"emissiveTexture", &m.emission_texture}};
}

std::vector<NamedUse> uses_of(const MaterialLayers& l) {
  return {{"extensions.KHR_materials_specular.specularTexture", &l.specular_texture},
          {"extensions.KHR_materials_specular.specularColorTexture", &l.specular_color_texture},
          {"extensions.KHR_materials_transmission.transmissionTexture", &l.transmission_texture},
          {"extensions.KHR_materials_clearcoat.clearcoatTexture", &l.clearcoat_texture},
          {"extensions.KHR_materials_clearcoat.clearcoatRoughnessTexture", &l.clearcoat_roughness_texture},
          {"extensions.KHR_materials_clearcoat.clearcoatNormalTexture", &l.clearcoat_normal_texture},
          {"extensions.KHR_materials_sheen.sheenColorTexture", &l.sheen_color_texture},
          {"extensions.KHR_materials_sheen.sheenRoughnessTexture", &l.sheen_roughness_texture}};
}

std::vector<NamedUse> all_uses_of(const Material& material) {
  std::vector<NamedUse> uses = uses_of(material);
  if (!material.layers) return uses;
  const std::vector<NamedUse> more = uses_of(*material.layers);
  uses.insert(uses.end(), more.begin(), more.end());
  return uses;
}

bool lacks(const Mesh& mesh, const TextureUse& use) {
  return use.texture >= 0 && mesh.uv[std::size_t(use.uv_set)].empty();
}

std::string text_of_mesh(const Mesh& mesh) {
  return mesh.name.empty() ? "a mesh" : fmt::format("mesh \"{}\"", shortened(mesh.name, 200));
}

}  // namespace

std::vector<std::string> warnings_of_missing_coordinates(const Scene& scene) {
  std::set<std::string> told;
  std::vector<std::string> warnings;
  for (const Mesh& mesh : scene.meshes) {
    for (const auto& [name, use] : all_uses_of(scene.materials[std::size_t(mesh.material)])) {
      if (!lacks(mesh, *use)) continue;
      const std::string place = fmt::format("materials[{}].{}", mesh.material, name);
      if (!told.insert(place).second) continue;
      warnings.push_back(fmt::format("{}: {} has no TEXCOORD_{}; the texture is not read there", place,
                                     text_of_mesh(mesh), use->uv_set));
    }
  }
  return warnings;
}

}  // namespace chiaro::renderer

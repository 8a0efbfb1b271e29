#include "renderer/io/gltf_materials.h"

#include <algorithm>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "renderer/core/world_limits.h"
#include "renderer/io/gltf_material_layers.h"
#include "renderer/io/gltf_textures.h"

namespace chiaro::renderer {
namespace {

template <class TextureInfo>
TextureUse use_of(GltfMaterialReader& reader, const char* name, const TextureInfo& info) {
  const auto transform = info.extensions.find("KHR_texture_transform");
  return texture_use(reader, name,
                     {info.index, info.texCoord, transform == info.extensions.end() ? nullptr : &transform->second});
}

AlphaMode alpha_mode(const GltfMaterialReader& reader, const std::string& mode) {
  if (mode == "OPAQUE") return AlphaMode::kOpaque;
  if (mode == "MASK") return AlphaMode::kMask;
  if (mode == "BLEND") return AlphaMode::kBlend;
  fail(reader.document, reader.place + ".alphaMode", fmt::format("is \"{}\"", mode.substr(0, 40)),
       "OPAQUE, MASK or BLEND");
}

double emissive_strength(const tinygltf::Material& material) {
  const auto extension = material.extensions.find("KHR_materials_emissive_strength");
  if (extension == material.extensions.end() || !extension->second.Has("emissiveStrength")) return 1;
  return extension->second.Get("emissiveStrength").GetNumberAsDouble();
}

Vec3f emission(const GltfMaterialReader& reader, const tinygltf::Material& material) {
  const double strength = emissive_strength(material);
  const auto& f = material.emissiveFactor;
  const Vec3f result{float(f[0] * strength), float(f[1] * strength), float(f[2] * strength)};
  if (!is_finite(result))
    fail(reader.document, reader.place + ".emissiveFactor", "its emission is not finite", "finite numbers");
  if (max_component(result) > kBrightest) {
    fail(reader.document, reader.place + ".emissiveFactor", "its emission is too bright",
         fmt::format("at most {:g} cd/m²", kBrightest));
  }
  return result;
}

// A picture and no part of the lighting, whatever else the material says.
void make_unlit(Material& material) {
  material.unlit = true;
  material.emission = {};
  material.layers.reset();
}

Material read_material(GltfMaterialReader& reader, const tinygltf::Material& source) {
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  const auto color = [&](int i) { return unit_factor(reader, "baseColorFactor", pbr.baseColorFactor[i]); };
  Material material;
  material.name = source.name;
  material.base_color = {color(0), color(1), color(2)};
  material.alpha = color(3);
  material.base_color_texture = use_of(reader, "baseColorTexture", pbr.baseColorTexture);
  material.metallic = unit_factor(reader, "metallicFactor", pbr.metallicFactor);
  material.roughness = unit_factor(reader, "roughnessFactor", pbr.roughnessFactor);
  material.metallic_roughness_texture = use_of(reader, "metallicRoughnessTexture", pbr.metallicRoughnessTexture);
  material.normal_texture = use_of(reader, "normalTexture", source.normalTexture);
  material.normal_scale = float(source.normalTexture.scale);
  material.emission = emission(reader, source);
  material.emission_texture = use_of(reader, "emissiveTexture", source.emissiveTexture);
  material.alpha_mode = alpha_mode(reader, source.alphaMode);
  material.alpha_cutoff = float(source.alphaCutoff);
  material.double_sided = source.doubleSided;
  material.layers = read_material_layers(reader, source);
  if (source.extensions.count("KHR_materials_unlit") > 0) make_unlit(material);
  return material;
}

}  // namespace

GltfMaterials read_materials(const GltfDocument& document, std::vector<std::string>& warnings, const Control& control) {
  GltfTextureList textures;
  GltfMaterials result;
  for (const tinygltf::Material& material : document.model->materials) {
    GltfMaterialReader reader{document, textures, warnings, fmt::format("materials[{}]", result.materials.size())};
    result.materials.push_back(read_material(reader, material));
  }
  result.textures = decode_textures(document, textures, control);
  return result;
}

}  // namespace chiaro::renderer

#include "renderer/io/gltf_materials.h"

#include <algorithm>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "renderer/io/gltf_textures.h"

namespace chiaro::renderer {
namespace {

struct Context {
  const GltfDocument& document;
  GltfTextureList& textures;
  std::vector<std::string>& warnings;
  std::string place;  // of the material
};

float factor(Context& context, const char* name, double value) {
  if (!(value >= 0 && value <= 1)) {
    context.warnings.push_back(fmt::format("{}.{}: {} is clamped to 0..1", context.place, name, value));
  }
  return float(std::clamp(value, 0.0, 1.0));
}

template <class TextureInfo>
TextureUse use_of(Context& context, const char* name, const TextureInfo& info) {
  if (info.index < 0) return {};
  const std::string place = fmt::format("{}.{}", context.place, name);
  TextureUse use;
  use.texture = context.textures.add(context.document, info.index, place, context.warnings);
  use.uv_set = info.texCoord;
  if (use.uv_set > 1) {
    context.warnings.push_back(fmt::format("{}: TEXCOORD_{} is not read; TEXCOORD_0 is used", place, use.uv_set));
    use.uv_set = 0;
  }
  return use;
}

AlphaMode alpha_mode(const Context& context, const std::string& mode) {
  if (mode == "OPAQUE") return AlphaMode::kOpaque;
  if (mode == "MASK") return AlphaMode::kMask;
  if (mode == "BLEND") return AlphaMode::kBlend;
  fail(context.document, context.place + ".alphaMode", fmt::format("is \"{}\"", mode.substr(0, 40)),
       "OPAQUE, MASK or BLEND");
}

double emissive_strength(const tinygltf::Material& material) {
  const auto extension = material.extensions.find("KHR_materials_emissive_strength");
  if (extension == material.extensions.end() || !extension->second.Has("emissiveStrength")) return 1;
  return extension->second.Get("emissiveStrength").GetNumberAsDouble();
}

Vec3f emission(const Context& context, const tinygltf::Material& material) {
  const double strength = emissive_strength(material);
  const auto& f = material.emissiveFactor;
  const Vec3f result{float(f[0] * strength), float(f[1] * strength), float(f[2] * strength)};
  if (!is_finite(result)) fail(context.document, context.place + ".emissiveFactor", "its emission is not finite");
  return result;
}

Material read_material(Context& context, const tinygltf::Material& source) {
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  const auto color = [&](int i) { return factor(context, "baseColorFactor", pbr.baseColorFactor[i]); };
  Material material;
  material.name = source.name;
  material.base_color = {color(0), color(1), color(2)};
  material.alpha = color(3);
  material.base_color_texture = use_of(context, "baseColorTexture", pbr.baseColorTexture);
  material.metallic = factor(context, "metallicFactor", pbr.metallicFactor);
  material.roughness = factor(context, "roughnessFactor", pbr.roughnessFactor);
  material.metallic_roughness_texture = use_of(context, "metallicRoughnessTexture", pbr.metallicRoughnessTexture);
  material.normal_texture = use_of(context, "normalTexture", source.normalTexture);
  material.normal_scale = float(source.normalTexture.scale);
  material.emission = emission(context, source);
  material.emission_texture = use_of(context, "emissiveTexture", source.emissiveTexture);
  material.alpha_mode = alpha_mode(context, source.alphaMode);
  material.alpha_cutoff = float(source.alphaCutoff);
  material.double_sided = source.doubleSided;
  return material;
}

}  // namespace

GltfMaterials read_materials(const GltfDocument& document, std::vector<std::string>& warnings) {
  GltfTextureList textures;
  GltfMaterials result;
  for (const tinygltf::Material& material : document.model->materials) {
    Context context{document, textures, warnings, fmt::format("materials[{}]", result.materials.size())};
    result.materials.push_back(read_material(context, material));
  }
  result.textures = decode_textures(document, textures);
  return result;
}

}  // namespace chiaro::renderer

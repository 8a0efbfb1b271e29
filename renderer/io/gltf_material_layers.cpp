#include "renderer/io/gltf_material_layers.h"

#include <algorithm>

#include <fmt/format.h>
#include <tiny_gltf.h>

namespace chiaro::renderer {
namespace {

using tinygltf::Value;

const Value* find_extension(const tinygltf::Material& material, const char* name) {
  const auto found = material.extensions.find(name);
  return found == material.extensions.end() ? nullptr : &found->second;
}

float unit_member(GltfMaterialReader& reader, const Value& extension, const std::string& name, double absent) {
  return unit_factor(reader, name, number_member(extension, name, absent));
}

Vec3f unit_color(GltfMaterialReader& reader, const Value& extension, const std::string& name, Vec3f absent) {
  const Vec3f color = color_member(extension, name, absent);
  return {unit_factor(reader, name, color.x), unit_factor(reader, name, color.y), unit_factor(reader, name, color.z)};
}

// What bends more is a mirror as this is, to a hundred-thousandth.
constexpr double kMostIor = 1e6;

void read_ior(GltfMaterialReader& reader, const Value& extension, MaterialLayers& layers) {
  const double ior = number_member(extension, "ior", 1.5);
  if (ior != 0 && ior < 1) {
    reader.warnings.push_back(fmt::format("{}.ior: {} is raised to 1", reader.place, ior));
  }
  layers.ior = ior == 0 ? 0 : float(std::clamp(ior, 1.0, kMostIor));
}

void read_specular(GltfMaterialReader& reader, const Value& extension, MaterialLayers& layers) {
  layers.specular = unit_member(reader, extension, "specularFactor", 1);
  layers.specular_texture = texture_member(reader, extension, "specularTexture");
  layers.specular_color = color_member(extension, "specularColorFactor", {1, 1, 1});
  layers.specular_color_texture = texture_member(reader, extension, "specularColorTexture");
}

void read_transmission(GltfMaterialReader& reader, const Value& extension, MaterialLayers& layers) {
  layers.transmission = unit_member(reader, extension, "transmissionFactor", 0);
  layers.transmission_texture = texture_member(reader, extension, "transmissionTexture");
}

// Over one metre, where the colour is what white light has become after `distance` of them.
float absorption_of(float color, double distance) {
  constexpr float kDarkest = 1e-6F;  // black would need an infinite absorption
  return float(-std::log(std::max(color, kDarkest)) / distance);
}

// The thickness is that of the mesh, whatever its texture says for rasterisers.
void read_volume(GltfMaterialReader& reader, const Value& extension, MaterialLayers& layers) {
  layers.solid = layers.transmission > 0 && number_member(extension, "thicknessFactor", 0) > 0;
  if (!layers.solid || !extension.Has("attenuationDistance")) return;
  const double distance = number_member(extension, "attenuationDistance", 1);
  const Vec3f color = unit_color(reader, extension, "attenuationColor", {1, 1, 1});
  layers.absorption = {absorption_of(color.x, distance), absorption_of(color.y, distance),
                       absorption_of(color.z, distance)};
  if (is_finite(layers.absorption)) return;
  fail(reader.document, reader.place + ".attenuationDistance", fmt::format("is {}", distance), "a longer one");
}

void read_clearcoat(GltfMaterialReader& reader, const Value& extension, MaterialLayers& layers) {
  layers.clearcoat = unit_member(reader, extension, "clearcoatFactor", 0);
  layers.clearcoat_texture = texture_member(reader, extension, "clearcoatTexture");
  layers.clearcoat_roughness = unit_member(reader, extension, "clearcoatRoughnessFactor", 0);
  layers.clearcoat_roughness_texture = texture_member(reader, extension, "clearcoatRoughnessTexture");
  layers.clearcoat_normal_texture = texture_member(reader, extension, "clearcoatNormalTexture");
  if (!extension.Has("clearcoatNormalTexture")) return;
  layers.clearcoat_normal_scale = float(number_member(extension.Get("clearcoatNormalTexture"), "scale", 1));
}

void read_sheen(GltfMaterialReader& reader, const Value& extension, MaterialLayers& layers) {
  layers.sheen_color = unit_color(reader, extension, "sheenColorFactor", {0, 0, 0});
  layers.sheen_color_texture = texture_member(reader, extension, "sheenColorTexture");
  layers.sheen_roughness = unit_member(reader, extension, "sheenRoughnessFactor", 0);
  layers.sheen_roughness_texture = texture_member(reader, extension, "sheenRoughnessTexture");
}

struct ExtensionReader {
  const char* name;
  void (*read)(GltfMaterialReader&, const Value&, MaterialLayers&);
};

constexpr ExtensionReader kReaders[] = {{"KHR_materials_ior", read_ior},
                                        {"KHR_materials_specular", read_specular},
                                        {"KHR_materials_transmission", read_transmission},
                                        {"KHR_materials_volume", read_volume},  // after _transmission
                                        {"KHR_materials_clearcoat", read_clearcoat},
                                        {"KHR_materials_sheen", read_sheen}};

bool change_nothing(const MaterialLayers& layers) {
  const bool plain_specular = layers.ior == 1.5F && layers.specular == 1 && layers.specular_texture.texture < 0 &&
                              layers.specular_color == Vec3f{1, 1, 1} && layers.specular_color_texture.texture < 0;
  return plain_specular && layers.transmission == 0 && layers.clearcoat == 0 && max_component(layers.sheen_color) == 0;
}

}  // namespace

std::optional<MaterialLayers> read_material_layers(GltfMaterialReader& reader, const tinygltf::Material& source) {
  MaterialLayers layers;
  const std::string place = reader.place;
  for (const ExtensionReader& extension : kReaders) {
    const Value* value = find_extension(source, extension.name);
    if (value == nullptr) continue;
    reader.place = fmt::format("{}.extensions.{}", place, extension.name);
    extension.read(reader, *value, layers);
  }
  reader.place = place;
  return change_nothing(layers) ? std::nullopt : std::optional(layers);
}

}  // namespace chiaro::renderer

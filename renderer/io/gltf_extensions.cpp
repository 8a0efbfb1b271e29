#include "renderer/io/gltf_extensions.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

namespace chiaro::renderer {
namespace {

constexpr std::string_view kRead[] = {"KHR_lights_punctual",     "KHR_materials_emissive_strength",
                                      "KHR_mesh_quantization",   "EXT_texture_webp",
                                      "EXT_texture_avif",        "EXT_mesh_gpu_instancing",
                                      "EXT_lights_image_based",  "KHR_draco_mesh_compression",
                                      "EXT_meshopt_compression", "KHR_node_visibility"};

// Of materials, and how their textures are placed.
constexpr std::string_view kReadOfMaterials[] = {
    "KHR_texture_transform",      "KHR_materials_ior",    "KHR_materials_specular",
    "KHR_materials_transmission", "KHR_materials_volume", "KHR_materials_clearcoat",
    "KHR_materials_sheen",        "KHR_materials_unlit",  "KHR_materials_variants"};

// They change nothing that is rendered: what a scene looks like without them is what it looks like.
constexpr std::string_view kWithoutEffect[] = {"KHR_xmp",
                                               "KHR_xmp_json_ld",
                                               "KHR_animation_pointer",
                                               "KHR_node_hoverability",
                                               "KHR_node_selectability",
                                               "GODOT_single_root",
                                               "MSFT_lod",
                                               "EXT_structural_metadata",
                                               "EXT_mesh_features"};

// Files that do not require them carry the same content in plain form beside it.
constexpr std::string_view kWithFallback[] = {"KHR_texture_basisu", "MSFT_texture_dds"};

template <std::size_t N>
bool contains(const std::string_view (&names)[N], const std::string& name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

bool is_read(const std::string& name) {
  return contains(kRead, name) || contains(kReadOfMaterials, name) || contains(kWithoutEffect, name);
}

}  // namespace

void check_extensions(GltfDocument& document) {
  for (const std::string& name : document.json.extensions_required) {
    if (is_read(name)) continue;
    fail(document, "extensionsRequired", fmt::format("{} is not read here", name), "a scene that does without it");
  }
  for (const std::string& name : document.json.extensions_used) {
    if (is_read(name) || contains(kWithFallback, name)) continue;
    document.warnings.push_back(fmt::format("extension {} is not read; what it changes is left out", name));
  }
}

}  // namespace chiaro::renderer

#pragma once
// What reading a material needs, and the values that materials are made of.

#include <string>
#include <vector>

#include "renderer/io/gltf_document.h"
#include "renderer/io/gltf_textures.h"
#include "renderer/scene/texture_use.h"

namespace tinygltf {
class Value;
}

namespace chiaro::renderer {

struct GltfMaterialReader {
  const GltfDocument& document;
  GltfTextureList& textures;
  std::vector<std::string>& warnings;
  std::string place;  // "materials[0]"
};

// A factor that has to be 0 to 1; clamped, with a warning that names it.
float unit_factor(GltfMaterialReader& reader, const std::string& name, double value);

// A textureInfo; `transform`: its KHR_texture_transform, or nullptr.
struct GltfTextureInfo {
  int index = -1;  // < 0: none
  int uv_set = 0;
  const tinygltf::Value* transform = nullptr;
};
TextureUse texture_use(GltfMaterialReader& reader, const std::string& name, const GltfTextureInfo& info);

// The same from within an extension: a member of `extension`, none where it has no such member.
TextureUse texture_member(GltfMaterialReader& reader, const tinygltf::Value& extension, const std::string& name);
double number_member(const tinygltf::Value& extension, const std::string& name, double absent);
Vec3f color_member(const tinygltf::Value& extension, const std::string& name, Vec3f absent);

}  // namespace chiaro::renderer

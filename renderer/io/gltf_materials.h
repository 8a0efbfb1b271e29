#pragma once
// Materials and the textures they use.

#include <string>
#include <vector>

#include "renderer/core/control.h"
#include "renderer/io/gltf_document.h"
#include "renderer/scene/scene.h"

namespace chiaro::renderer {

struct GltfMaterials {
  std::vector<Material> materials;  // as many as the file has, in its order
  std::vector<Texture> textures;    // those that the materials use, decoded
};

// Error for a texture that is missing or cannot be decoded, naming it. control: to be interrupted.
GltfMaterials read_materials(const GltfDocument& document, std::vector<std::string>& warnings, const Control& control);

}  // namespace chiaro::renderer

#pragma once

#include <optional>

#include "renderer/io/gltf_material_reader.h"
#include "renderer/scene/material_layers.h"

namespace tinygltf {
struct Material;
}

namespace chiaro::renderer {

// KHR_materials_ior, _specular, _transmission, _volume, _clearcoat and _sheen of a material; absent where they change
// nothing.
std::optional<MaterialLayers> read_material_layers(GltfMaterialReader& reader, const tinygltf::Material& source);

}  // namespace chiaro::renderer

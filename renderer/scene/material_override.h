#pragma once

#include <optional>

#include "renderer/scene/scene.h"

namespace chiaro::renderer {

enum class MaterialModel : std::uint8_t {
  kGltf,     // as the file says
  kDiffuse,  // Lambert of the base colour; no normal maps, no emission; alpha kept
};

struct MaterialOverride {
  MaterialModel model = MaterialModel::kGltf;
  std::optional<Vec3f> albedo;  // every surface a Lambert of this; alpha kept, no emission
};

// The scene with its materials replaced, as lighting artists' clay renders do.
Scene with_materials(Scene scene, const MaterialOverride& materials);

}  // namespace chiaro::renderer

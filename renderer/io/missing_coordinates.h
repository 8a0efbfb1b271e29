#pragma once
// Textures whose coordinates a mesh has not.

#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace chiaro::renderer {

// A warning for each texture of a material that a mesh shows without the TEXCOORD_n that it is laid out by, once. There
// the factor stands alone, as 1 in the texture would leave it. The materials are those of a glTF file, in its order.
std::vector<std::string> warnings_of_missing_coordinates(const Scene& scene);

}  // namespace chiaro::renderer

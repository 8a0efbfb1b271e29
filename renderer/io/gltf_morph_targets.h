#pragma once
// Morph targets: displacements of vertices, blended by weights.

#include <vector>

#include "renderer/io/gltf_document.h"
#include "renderer/io/gltf_primitives.h"

namespace chiaro::renderer {

// Adds the weighted targets of a primitive to its mesh: POSITION, NORMAL, TANGENT, TEXCOORD_n and COLOR_0. Targets
// beyond the weights given have none. Error for targets of another number of vertices than the primitive.
void add_morph_targets(const GltfDocument& document, const GltfPrimitiveRef& ref, const std::vector<float>& weights,
                       Mesh& mesh);

}  // namespace chiaro::renderer

#pragma once
// Skins: vertices that follow the joints of a skeleton.

#include <vector>

#include "renderer/core/vec.h"
#include "renderer/io/gltf_document.h"
#include "renderer/io/gltf_primitives.h"

namespace chiaro::renderer {

// Per joint of a skin, where it carries what was modelled around it, given the transforms of all nodes. Error for
// inverse bind matrices that are missing or not finite.
std::vector<Mat4f> world_from_bind(const GltfDocument& document, int skin, const std::vector<Mat4f>& world_from_nodes);

bool has_joints(const GltfDocument& document, const GltfPrimitiveRef& ref);

// Moves a mesh from where it was modelled into the world. Triangles that joints mirror are turned round. JOINTS_n and
// WEIGHTS_n of any n. Returns the number of vertices whose weights had to be mended: what is not finite or negative
// counts as none, sums become 1, and vertices without weight follow their first joint. Error for joints that are not
// there.
std::size_t skin_mesh(const GltfDocument& document, const GltfPrimitiveRef& ref,
                      const std::vector<Mat4f>& world_from_bind, Mesh& mesh);

}  // namespace chiaro::renderer

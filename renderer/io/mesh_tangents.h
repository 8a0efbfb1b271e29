#pragma once

#include "renderer/scene/scene.h"

namespace chiaro::renderer {

// Gives a mesh the tangents that glTF wants where a file has none: MikkTSpace of positions, normals and texture
// coordinate set `uv_set`, which must be there. Vertices at which tangents differ, as along seams of mirrored
// coordinates, become several.
void make_tangents(Mesh& mesh, int uv_set);

}  // namespace chiaro::renderer

#pragma once

#include <cstdint>
#include <vector>

#include "renderer/scene/scene.h"

namespace chiaro::renderer {

// Makes new vertices out of those of a mesh: vertex i becomes what vertex sources[i] was. Triangles are the caller's.
void gather_vertices(Mesh& mesh, const std::vector<std::uint32_t>& sources);

}  // namespace chiaro::renderer

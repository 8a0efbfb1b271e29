#pragma once

#include "renderer/scene/scene.h"

namespace chiaro::renderer {

// Makes the mip maps of every texture that a material uses.
void make_mip_maps(Scene& scene);

}  // namespace chiaro::renderer

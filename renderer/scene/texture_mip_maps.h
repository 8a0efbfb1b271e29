#pragma once

#include "renderer/core/control.h"
#include "renderer/scene/scene.h"

namespace chiaro::renderer {

// Makes the mip maps of every texture that a material uses. Textures that materials use in several ways, as colour and
// as data, or with alpha as coverage and without, are copied: each way has its own.
void make_mip_maps(Scene& scene, const Control& control = {});

}  // namespace chiaro::renderer

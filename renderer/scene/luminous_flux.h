#pragma once

#include <optional>

#include "renderer/scene/light.h"

namespace chiaro::renderer {

// Lumens that a light sends out: of a point light 4π times its luminous intensity; of a spot light that within its
// cone, with the fall from the inner to the outer angle. None of lights from infinitely far away.
std::optional<double> luminous_flux(const Light& light);

}  // namespace chiaro::renderer

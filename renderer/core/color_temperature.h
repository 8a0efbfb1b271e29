#pragma once

#include <optional>

#include "renderer/core/vec.h"

namespace chiaro::renderer {

struct ColorTemperature {
  double kelvin = 0;  // correlated: of the nearest black body in CIE 1960 u, v
  double duv = 0;     // distance from it there; above zero: greener, below: more purple
};

// Of a scene-linear Rec.709 colour. None for black, for colours farther than 0.05 from all black bodies (CIE 15), and
// for those that are nearest to an end of the range of blackbody.h.
std::optional<ColorTemperature> correlated_color_temperature(Vec3f rec709);

}  // namespace chiaro::renderer

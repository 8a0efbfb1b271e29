#pragma once

#include "renderer/core/vec.h"

namespace chiaro::renderer {

inline constexpr double kLeastKelvin = 1667, kMostKelvin = 25000;

// CIE 1931 chromaticity.
struct Chromaticity {
  double x = 0, y = 0;
};

// The Planckian locus, by the cubic splines of Kim et al. (below). kelvin: from kLeastKelvin to kMostKelvin.
Chromaticity planckian_locus(double kelvin);

// Scene-linear Rec.709 colour of a black body (Planckian locus), its largest channel 1, none below 0. kelvin: from
// kLeastKelvin to kMostKelvin. Source: Kim, Kim, Lee, Jung, Design of color temperature converters by using a cubic
// spline approximation of the Planckian locus, 2002.
Vec3f blackbody_color(double kelvin);

}  // namespace chiaro::renderer

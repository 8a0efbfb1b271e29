#pragma once

#include <cmath>

namespace chiaro::renderer {

// The linear value of one on the sRGB curve, IEC 61966-2-1.
template <class Real>
Real linear_from_srgb(Real value) {
  return value <= Real(0.04045) ? value / Real(12.92) : std::pow((value + Real(0.055)) / Real(1.055), Real(2.4));
}

}  // namespace chiaro::renderer

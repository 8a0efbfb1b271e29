#pragma once
// The sRGB curve, IEC 61966-2-1.

#include <cmath>

namespace chiaro::renderer {

template <class Real>
Real linear_from_srgb(Real value) {
  return value <= Real(0.04045) ? value / Real(12.92) : std::pow((value + Real(0.055)) / Real(1.055), Real(2.4));
}

template <class Real>
Real srgb_from_linear(Real value) {
  return value <= Real(0.0031308) ? value * Real(12.92) : Real(1.055) * std::pow(value, 1 / Real(2.4)) - Real(0.055);
}

}  // namespace chiaro::renderer

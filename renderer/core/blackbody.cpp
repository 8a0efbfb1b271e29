#include "renderer/core/blackbody.h"

#include <algorithm>

namespace chiaro::renderer {
namespace {

// CIE 1931 x of the Planckian locus.
double locus_x(double t) {
  if (t <= 4000) return ((-0.2661239e9 / t - 0.2343589e6) / t + 0.8776956e3) / t + 0.179910;
  return ((-3.0258469e9 / t + 2.1070379e6) / t + 0.2226347e3) / t + 0.240390;
}

double locus_y(double t, double x) {
  if (t <= 2222) return ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683;
  if (t <= 4000) return ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867;
  return ((3.0817580 * x - 5.87338670) * x + 3.75112997) * x - 0.37001483;
}

}  // namespace

Chromaticity planckian_locus(double kelvin) {
  const double t = std::clamp(kelvin, kLeastKelvin, kMostKelvin), x = locus_x(t);
  return {x, locus_y(t, x)};
}

Vec3f blackbody_color(double kelvin) {
  const auto [x, y] = planckian_locus(kelvin);
  const double X = x / y, Z = (1 - x - y) / y;
  const double r = 3.2409699 * X - 1.5373832 - 0.4986108 * Z;
  const double g = -0.9692436 * X + 1.8759675 + 0.0415551 * Z;
  const double b = 0.0556301 * X - 0.2039770 + 1.0569715 * Z;
  const double most = std::max({r, g, b});
  return {float(std::max(r, 0.0) / most), float(std::max(g, 0.0) / most), float(std::max(b, 0.0) / most)};
}

}  // namespace chiaro::renderer

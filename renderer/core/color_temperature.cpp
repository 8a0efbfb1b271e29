#include "renderer/core/color_temperature.h"

#include <cmath>

#include "renderer/core/blackbody.h"

namespace chiaro::renderer {
namespace {

constexpr double kFarthest = 0.05;  // of black bodies, in u, v, or less
constexpr double kMegaKelvin = 1e6;
constexpr int kSteps = 200;  // over the range, in reciprocal kelvin, which is about even in u, v
constexpr int kThirds = 60;

struct Uv {
  double u = 0, v = 0;
};

// CIE 1960.
Uv uv_of(Chromaticity c) {
  const double scale = 1 / (-2 * c.x + 12 * c.y + 3);
  return {4 * c.x * scale, 6 * c.y * scale};
}

Chromaticity chromaticity_of(Vec3f c) {
  const double X = 0.4123908 * c.x + 0.3575843 * c.y + 0.1804808 * c.z;
  const double Y = 0.2126390 * c.x + 0.7151687 * c.y + 0.0721923 * c.z;
  const double Z = 0.0193308 * c.x + 0.1191948 * c.y + 0.9505322 * c.z;
  return {X / (X + Y + Z), Y / (X + Y + Z)};
}

double distance(Uv uv, double mired) {
  const Uv locus = uv_of(planckian_locus(kMegaKelvin / mired));
  return std::hypot(uv.u - locus.u, uv.v - locus.v);
}

double mired_at(int step) {
  const double least = kMegaKelvin / kMostKelvin, most = kMegaKelvin / kLeastKelvin;
  return least + (most - least) * step / kSteps;
}

// Where the distance is least, by ternary search.
double nearest_between(Uv uv, double low, double high) {
  for (int i = 0; i < kThirds; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (distance(uv, a) < distance(uv, b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return (low + high) / 2;
}

}  // namespace

std::optional<ColorTemperature> correlated_color_temperature(Vec3f rec709) {
  if (!is_finite(rec709) || min_component(rec709) < 0 || max_component(rec709) <= 0) return std::nullopt;
  const Uv uv = uv_of(chromaticity_of(rec709));
  int nearest = 0;
  for (int step = 1; step <= kSteps; ++step) {
    if (distance(uv, mired_at(step)) < distance(uv, mired_at(nearest))) nearest = step;
  }
  if (nearest == 0 || nearest == kSteps) return std::nullopt;
  const double mired = nearest_between(uv, mired_at(nearest - 1), mired_at(nearest + 1));
  const double apart = distance(uv, mired);
  if (apart > kFarthest) return std::nullopt;
  const bool above = uv.v > uv_of(planckian_locus(kMegaKelvin / mired)).v;
  return ColorTemperature{kMegaKelvin / mired, above ? apart : -apart};
}

}  // namespace chiaro::renderer

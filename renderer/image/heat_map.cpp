#include "renderer/image/heat_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/image/srgb_curve.h"

namespace chiaro::renderer {
namespace {

// Ottosson, A perceptual color space for image processing (Oklab), 2020: linear Rec.709 of lightness, a, b.
Vec3f linear_of_oklab(float lightness, float a, float b) {
  const float l = lightness + 0.3963377774F * a + 0.2158037573F * b;
  const float m = lightness - 0.1055613458F * a - 0.0638541728F * b;
  const float s = lightness - 0.0894841775F * a - 1.2914855480F * b;
  const Vec3f lms{l * l * l, m * m * m, s * s * s};
  return {4.0767416621F * lms.x - 3.3077115913F * lms.y + 0.2309699292F * lms.z,
          -1.2684380046F * lms.x + 2.6097574011F * lms.y - 0.3413193965F * lms.z,
          -0.0041960863F * lms.x - 0.7034186147F * lms.y + 1.7076147010F * lms.z};
}

float on_srgb_curve(float linear) { return srgb_from_linear(std::clamp(linear, 0.0F, 1.0F)); }

}  // namespace

Vec3f heat_color(float value) {
  const float t = value > 0 ? std::min(value, 1.0F) : 0;
  const float pi = std::numbers::pi_v<float>;
  const float lightness = 0.05F + 0.93F * t;
  const float chroma = 0.2F * std::pow(std::sin(pi * (0.03F + 0.87F * t)), 0.8F);
  const float hue = pi / 180 * (285 + 185 * t);
  const Vec3f linear = linear_of_oklab(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
  return {on_srgb_curve(linear.x), on_srgb_curve(linear.y), on_srgb_curve(linear.z)};
}

Image heat_map(const Image& values) {
  Image picture = make_image(values.width, values.height, {"R", "G", "B"});
  for (int y = 0; y < values.height; ++y) {
    for (int x = 0; x < values.width; ++x) {
      const Vec3f color = heat_color(*values.at(x, y));
      for (int c = 0; c < 3; ++c) picture.at(x, y)[c] = color[c];
    }
  }
  return picture;
}

}  // namespace chiaro::renderer

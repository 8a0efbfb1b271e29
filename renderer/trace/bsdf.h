#pragma once
// Scattering at a surface: Lambert, or glTF 2.0's metallic-roughness (appendix B of the specification):
//   f = (1 − metallic) [ (1 − F_d) c/π + F_d S ] + metallic F_m S,  S = V D,
// D: GGX of α = roughness², V: height-correlated Smith, F: Schlick with F0 = 0.04 and F0 = c.
// Directions are unit and point away from the surface.

#include <optional>

#include "renderer/trace/surface_point.h"

namespace chiaro::renderer {

class Bsdf {
 public:
  explicit Bsdf(const SurfacePoint& point);

  // f · cosθ_i, per channel; zero below either horizon.
  Vec3f eval(Vec3f to_viewer, Vec3f to_light) const;
  // Density of sample(), per steradian.
  float pdf(Vec3f to_viewer, Vec3f to_light) const;

  struct Sample {
    Vec3f direction;
    Vec3f weight;  // f · cosθ / pdf
    float pdf = 0;
  };
  std::optional<Sample> sample(Vec3f to_viewer, Vec2f u, float lobe) const;

 private:
  float specular_probability(Vec3f to_viewer) const;
  bool above_horizon(Vec3f direction) const;

  Frame3f frame_;
  Vec3f geometric_normal_;
  Vec3f base_color_;
  float metallic_, alpha_;
  bool lambert_;
};

// Fraction of the light falling on a point under a cosine-weighted sky that it sends back: albedo of the Lambert
// surface that is closest in energy.
Vec3f hemispherical_albedo(const SurfacePoint& point);

}  // namespace chiaro::renderer

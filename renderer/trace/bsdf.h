#pragma once
// Scattering at a surface: Lambert, or glTF 2.0's metallic-roughness (appendix B of the specification):
//   f = (1 − metallic) (diffuse + F_d S) + metallic F_m S,  S = V D,
// D: GGX of α = roughness², V: height-correlated Smith, F: Schlick with F0 = 0.04 and F0 = base colour c. In the
// appendix' simplest form, diffuse = (1 − F_d) c/π, a white surface sends back up to 1.2 times the light that falls on
// it at grazing angles. Here the diffuse part gets just what the coat leaves, so that a white dielectric's albedo is
// one:
//   diffuse = c/π (1 − E(θ_o)) (1 − E(θ_i)) / (1 − E_mean),  E: albedo of F_d S.
// Source of the last: Kelemen & Szirmay-Kalos, A Microfacet Based Coupled Specular-Matte BRDF Model, 2001.
// Where a normal map has turned the normal, diffuse light fades before the smooth surface turns away from it.
// Source: Chiang, Li, Burley, Taming the Shadow Terminator, 2019.
// Directions are unit and point away from the surface.

#include <optional>

#include "renderer/trace/surface_point.h"

namespace chiaro::renderer {

class Bsdf {
 public:
  explicit Bsdf(const SurfacePoint& point);
  Vec3f normal() const { return frame_.normal; }  // shading normal
  // How much it scatters, roughly: a diffuse part, and one about the mirror direction.
  struct Sketch {
    float diffuse = 1, specular = 0;  // albedo; specular at normal incidence
    float alpha = 1;                  // GGX
  };
  Sketch sketch() const;

  // f · cosθ_i, per channel; zero below the shading normal's horizon, and where the light is below both the triangle's
  // and the smooth surface's that vertex normals stand for.
  Vec3f eval(Vec3f to_viewer, Vec3f to_light) const;
  // Density of sample(), per steradian. Nothing below the triangle's horizon is sampled: rays would meet the triangle.
  float pdf(Vec3f to_viewer, Vec3f to_light) const;

  struct Sample {
    Vec3f direction;
    Vec3f weight;  // f · cosθ / pdf
    float pdf = 0;
  };
  std::optional<Sample> sample(Vec3f to_viewer, Vec2f u, float lobe) const;

 private:
  float specular_probability(Vec3f to_viewer) const;
  bool above_triangle(Vec3f direction) const;
  bool above_horizon(Vec3f direction) const;
  float shadow_terminator(Vec3f to_light) const;

  Frame3f frame_;
  Vec3f geometric_normal_;
  Vec3f smooth_normal_;
  bool turned_;  // the shading normal is another one
  Vec3f base_color_;
  float metallic_, alpha_;
  bool lambert_;
};

// Fraction of the light falling on a point under a cosine-weighted sky that it sends back: albedo of the Lambert
// surface that is closest in energy.
Vec3f hemispherical_albedo(const SurfacePoint& point);

}  // namespace chiaro::renderer

#pragma once
// glTF 2.0's metallic-roughness (appendix B of the specification), with what KHR_materials_ior, _specular,
// _transmission and _volume change in its dielectric:
//   f = (1 − metallic) (base + F_d S) + metallic F_m S,  S = V D,
// D: GGX of α = roughness², V: height-correlated Smith, F: Schlick; F_d from f0 to f90, F_m from the base colour c
// to 1. base is a mix by `transmission` of
// - diffuse light. In the appendix' simplest form, (1 − F_d) c/π, a white surface sends back up to 1.2 times the light
//   that falls on it at grazing angles. Here it gets just what the coat leaves, so that a white dielectric's albedo is
//   one: c/π (1 − E(θ_o)) (1 − E(θ_i)) / (1 − E_mean), E: albedo of F_d S.
//   Source: Kelemen & Szirmay-Kalos, A Microfacet Based Coupled Specular-Matte BRDF Model, 2001.
// - light that the facets let through: through a thin sheet or into a solid. The boundary of a solid reflects by
//   Fresnel's equations, from inside too.
// What rough metals, thin sheets and the boundaries of solids lose where facets scatter light but once is given back as
// diffuse light, of metals tinted by as many reflections as it takes, of boundaries on both sides (Kulla & Conty,
// Revisiting Physically Based Shading at Imageworks, 2017). Directions are unit, in the frame of the shading normal
// (+Z), which the viewer is above.

#include <optional>

#include "renderer/trace/surface_point.h"

namespace chiaro::renderer {

// The size of the source that light comes from, as far as scattering needs to know.
enum class LightSource : std::uint8_t {
  kExtended,  // emitting surfaces, skies: found by scattered rays too
  kPunctual,  // never met by scattered rays; clear surfaces leave them to shadow rays
  // Mirrors show them as a lamp's size would.
  kPunctualWidened,
  // The same after rough scattering: mirrors and polish throw blurred caustics instead of rare bright dots.
  // Source: Kaplanyan & Dachsbacher, Path Space Regularization for Holistic and Robust Light Transport, 2013.
  kPunctualBlurred,
};

// How much a surface scatters, roughly: a diffuse part, and one about the mirror direction.
struct BsdfSketch {
  float diffuse = 1, specular = 0;  // albedo; specular at normal incidence
  float alpha = 1;                  // GGX
};

float least_alpha(float roughness);                    // roughness², and no less than floats can take
float widened_alpha(float alpha, LightSource source);  // as the kind of source asks for
// By what a widened lobe is brighter, so that all of its light together stays the same. cosine: of the viewer.
float widening_gain(float cosine, float alpha, float widened);
bool is_rough(float alpha);  // spreads light more than kPunctualBlurred would

class BsdfBase {
 public:
  explicit BsdfBase(const SurfacePoint& point);

  // f · |cosθ_i|, per channel; without what goes straight through. diffuse_fade: a factor of the diffuse part.
  Vec3f eval(Vec3f wo, Vec3f wi, LightSource source, float diffuse_fade) const;
  // Density of sample(), per steradian; without what goes straight through.
  float pdf(Vec3f wo, Vec3f wi) const;

  struct Sample {
    Vec3f direction;
    bool straight = false;  // through the sheet; pdf() and eval() know nothing of it
    float probability = 1;  // of going straight
    bool rough = true;      // the direction is spread more than kPunctualBlurred spreads it
  };
  std::optional<Sample> sample(Vec3f wo, Vec2f u, float lobe) const;

  // What goes straight through, of all light from wo.
  Vec3f straight(Vec3f wo) const;
  // What a shadow ray brings through: as straight(), and through the clear boundary of a solid as if it did not
  // refract.
  Vec3f clear(Vec3f wo) const;

  bool transmits() const { return transmission_ > 0; }
  BsdfSketch sketch() const;
  float albedo(Vec3f wo) const { return weights(wo).total(); }  // roughly, luminance
  // Of the reflected part, under a cosine-weighted sky.
  Vec3f hemispherical_reflectance() const;

 private:
  // Albedos of the lobes, roughly, by which they are sampled.
  struct Weights {
    float facets = 0, diffuse = 0, straight = 0, diffuse_transmission = 0;
    float total() const { return facets + diffuse + straight + diffuse_transmission; }
  };
  Weights weights(Vec3f wo) const;
  Vec3f dielectric_reflectance_of(float cosine) const;
  Vec3f facet_reflectance(float cosine) const;
  float facet_transmittance(float cosine) const;
  float reflect_probability(float cosine) const;
  Vec3f reflection(Vec3f wo, Vec3f wi, float alpha, float diffuse_fade) const;
  Vec3f transmission(Vec3f wo, Vec3f wi, LightSource source) const;
  float coat(float cosine) const;
  float mean_coat() const;
  bool seen_from_inside() const { return eta_ > 0 && eta_ < 1; }
  Vec3f scattered_by_metal() const;
  bool loses_at_boundary() const { return transmits() && refracts() && !clear_; }
  bool refracts() const { return eta_ > 0; }
  bool goes_straight() const { return clear_ && !refracts(); }

  Vec3f base_color_;
  float metallic_, alpha_;
  Vec3f f0_{0.04F, 0.04F, 0.04F};
  float coat_f0_ = 0.04F, f90_ = 1;         // coat_f0_: the largest of f0
  float transmission_ = 0, diffusion_ = 1;  // shares of the dielectric's base
  float eta_ = 0;                           // refractive index of the far side over the near side's; 0: thin
  bool clear_ = false;                      // is_clear()
  // Of what a rough boundary loses from either side: means, and the share of the near side's that it lets through.
  float near_loss_ = 0, far_loss_ = 0, lost_through_ = 0;
};

}  // namespace chiaro::renderer

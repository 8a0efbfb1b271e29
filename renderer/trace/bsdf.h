#pragma once
// Scattering at a surface: Lambert, or glTF's metallic-roughness (bsdf_base) under sheen (bsdf_sheen) under a clearcoat
// (bsdf_clearcoat). Directions are unit and point away from the surface; the viewer is on the side of the normals, the
// light on either.
// Where a normal map has turned the normal, diffuse light fades before the smooth surface turns away from it.
// Source: Chiang, Li, Burley, Taming the Shadow Terminator, 2019.

#include <optional>

#include "renderer/trace/bsdf_base.h"
#include "renderer/trace/bsdf_clearcoat.h"
#include "renderer/trace/bsdf_sheen.h"

namespace chiaro::renderer {

class Bsdf {
 public:
  explicit Bsdf(const SurfacePoint& point);
  Vec3f normal() const { return frame_.normal; }  // shading normal
  // All light that it scatters comes from above its horizon; zero: there is no such normal, as light goes through, or a
  // clearcoat has another horizon than what it covers.
  Vec3f light_normal() const;
  // How much it scatters, roughly. Of surfaces without such a normal: as much from all sides.
  using Sketch = BsdfSketch;
  Sketch sketch() const;

  // f · |cosθ_i|, per channel; zero where shading normal and triangle disagree about the side of the light, unless the
  // smooth surface that vertex normals stand for sees it, and for what goes straight through.
  Vec3f eval(Vec3f to_viewer, Vec3f to_light, LightSource source = LightSource::kExtended) const;
  // Density of sample(), per steradian; without what goes straight through. Nothing that is reflected below the
  // triangle's horizon is sampled: rays would meet the triangle.
  float pdf(Vec3f to_viewer, Vec3f to_light) const;

  struct Sample {
    Vec3f direction;
    Vec3f weight;  // f · |cosθ| / pdf
    float pdf = 0;
    bool straight = false;  // through a thin clear sheet, by chance: pdf is not set, as the path has not turned
    bool rough = true;      // spread widely enough for LightSource::kPunctualBlurred
  };
  std::optional<Sample> sample(Vec3f to_viewer, Vec2f u, float lobe) const;

  // Part of the light from behind a thin clear sheet that arrives from there unscattered; zero for other surfaces.
  Vec3f straight(Vec3f to_viewer) const;
  // Part that shadow rays of punctual lights bring through a clear sheet or the clear boundary of a solid.
  Vec3f clear(Vec3f to_viewer) const;

  bool transmits() const { return base_ && base_->transmits(); }

 private:
  struct Layers {
    BsdfSheen sheen;
    BsdfClearcoat clearcoat;
  };
  // Probabilities of sampling each.
  struct Choice {
    float clearcoat = 0, sheen = 0;
    float base() const { return 1 - clearcoat - sheen; }
  };
  Choice choice(Vec3f to_viewer, Vec3f wo) const;
  Vec3f eval_below_clearcoat(Vec3f to_viewer, Vec3f to_light, LightSource source) const;
  bool has_clearcoat_towards(Vec3f to_light) const;
  float below_layers(Vec3f to_viewer, Vec3f to_light) const;
  bool sides_agree(Vec3f direction, float local_z) const { return dot(direction, geometric_normal_) * local_z > 0; }
  bool sees(Vec3f direction, float local_z) const;
  float shadow_terminator(Vec3f to_light) const;
  std::optional<Sample> sample_lambert(Vec2f u) const;
  Sample straight_sample(Vec3f to_viewer, float probability) const;

  Frame3f frame_;
  Vec3f geometric_normal_;
  Vec3f smooth_normal_;
  bool turned_;  // the shading normal is another one
  Vec3f base_color_;
  bool geometric_horizon_;
  std::optional<BsdfBase> base_;  // absent: Lambert
  std::optional<Layers> layers_;  // absent: neither sheen nor clearcoat
};

// Fraction of the light falling on a point under a cosine-weighted sky that it sends back: albedo of the Lambert
// surface that is closest in energy.
Vec3f hemispherical_albedo(const SurfacePoint& point);

}  // namespace chiaro::renderer

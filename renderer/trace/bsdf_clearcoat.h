#pragma once
// KHR_materials_clearcoat: a colourless polish of refractive index 1.5 over everything else, with a normal of its own:
//   f = clearcoat F S + k f_below,  k = min(1 − clearcoat E(θ_o), 1 − clearcoat E(θ_i)),  E: albedo of F S,
// which keeps the sum reciprocal and lets nothing send back more than it gets.

#include <optional>

#include "renderer/trace/bsdf_base.h"

namespace chiaro::renderer {

class BsdfClearcoat {
 public:
  // Of a point with layers. Directions are in the world, unit, on any side.
  explicit BsdfClearcoat(const SurfacePoint& point);

  bool present() const { return strength_ > 0; }
  Vec3f normal() const { return frame_.normal; }
  float cosine(Vec3f direction) const { return dot(direction, frame_.normal); }
  Vec3f eval(Vec3f to_viewer, Vec3f to_light, LightSource source) const;  // f · cosθ_i
  float pdf(Vec3f to_viewer, Vec3f to_light) const;
  std::optional<Vec3f> sample(Vec3f to_viewer, Vec2f u) const;
  float albedo(Vec3f direction) const;  // what it sends back
  float below(Vec3f to_viewer, Vec3f to_light) const { return 1 - std::max(albedo(to_viewer), albedo(to_light)); }
  float mean_albedo() const;  // under a cosine-weighted sky …
  float mean_below() const;   // … and what is left for what is below
  bool rough() const;         // as BsdfBase::Sample

 private:
  Frame3f frame_;
  float strength_, alpha_;
};

}  // namespace chiaro::renderer

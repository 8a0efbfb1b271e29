#pragma once
// KHR_materials_sheen: light that the fibres of cloth send back at grazing angles:
//   f = sheen_color D V + s f_below,  s = min(1 − m E(θ_o), 1 − m E(θ_i)),  m: the colour's largest channel,
// D: Charlie, V: its fitted masking and shadowing, E: albedo of D V, held below one.
// Source: Estevez & Kulla, Production Friendly Microfacet Sheen BRDF, 2017.
// Directions are unit, in the frame of the shading normal (+Z), which the viewer is above.

#include "renderer/trace/surface_point.h"

namespace chiaro::renderer {

class BsdfSheen {
 public:
  explicit BsdfSheen(const SurfacePoint& point);  // with layers

  bool present() const { return strength_ > 0; }
  Vec3f eval(Vec3f wo, Vec3f wi) const;  // f · cosθ_i; zero below
  static float pdf(Vec3f wi);            // per steradian
  static Vec3f sample(Vec2f u);
  float albedo(float cosine) const;  // of its strongest channel
  float below(float cosine_o, float cosine_i) const { return 1 - std::max(albedo(cosine_o), albedo(cosine_i)); }
  Vec3f mean_albedo() const;  // under a cosine-weighted sky …
  float mean_below() const;   // … and of what is diffuse below

 private:
  Vec3f color_;
  float strength_, alpha_;
};

}  // namespace chiaro::renderer

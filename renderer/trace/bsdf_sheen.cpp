#include "renderer/trace/bsdf_sheen.h"

#include "renderer/trace/sheen_albedo.h"

namespace chiaro::renderer {

BsdfSheen::BsdfSheen(const SurfacePoint& point)
    : color_(point.layers->sheen_color),
      strength_(max_component(color_)),
      alpha_(point.layers->sheen_roughness * point.layers->sheen_roughness) {}

// Where the fitted formula sends back more than it gets, at grazing angles, it is scaled down, the same for both
// directions.
Vec3f BsdfSheen::eval(Vec3f wo, Vec3f wi) const {
  if (wi.z <= 0) return {};
  const float excess = std::max({1.0F, sheen_albedo(wo.z, alpha_), sheen_albedo(wi.z, alpha_)});
  return (sheen_value(normalize(wo + wi).z, wo.z, wi.z, alpha_) * wi.z / excess) * color_;
}

// Uniform over the hemisphere, which the source recommends.
float BsdfSheen::pdf(Vec3f wi) { return wi.z > 0 ? 0.5F * kInvPi : 0; }

Vec3f BsdfSheen::sample(Vec2f u) {
  const float sine = std::sqrt(std::max(0.0F, 1 - u.x * u.x)), phi = 2 * kPi * u.y;
  return {sine * std::cos(phi), sine * std::sin(phi), u.x};
}

float BsdfSheen::albedo(float cosine) const { return strength_ * std::min(1.0F, sheen_albedo(cosine, alpha_)); }

Vec3f BsdfSheen::mean_albedo() const { return mean_sheen_albedo(alpha_) * color_; }

float BsdfSheen::mean_below() const { return 1 - strength_ * mean_larger_sheen_albedo(alpha_); }

}  // namespace chiaro::renderer

#include "renderer/trace/bsdf_clearcoat.h"

#include "renderer/trace/fresnel.h"
#include "renderer/trace/ggx.h"
#include "renderer/trace/specular_albedo.h"

namespace chiaro::renderer {

BsdfClearcoat::BsdfClearcoat(const SurfacePoint& point)
    : frame_(point.layers->clearcoat_normal),
      strength_(point.layers->clearcoat),
      alpha_(least_alpha(point.layers->clearcoat_roughness)) {}

Vec3f BsdfClearcoat::eval(Vec3f to_viewer, Vec3f to_light, LightSource source) const {
  const Vec3f wo = frame_.local_from_world(to_viewer), wi = frame_.local_from_world(to_light);
  if (wo.z <= 0 || wi.z <= 0) return {};
  const float alpha = widened_alpha(alpha_, source);
  const Vec3f h = normalize(wo + wi);
  const float fresnel = clearcoat_reflectance(dot(wo, h));
  const float facets = ggx::distribution(h, alpha) * ggx::visibility(wo.z, wi.z, alpha);
  const float value = strength_ * fresnel * widening_gain(wo.z, alpha_, alpha) * facets * wi.z;
  return {value, value, value};
}

float BsdfClearcoat::pdf(Vec3f to_viewer, Vec3f to_light) const {
  const Vec3f wo = frame_.local_from_world(to_viewer), wi = frame_.local_from_world(to_light);
  return wo.z > 0 && wi.z > 0 ? ggx::reflection_pdf(wo, normalize(wo + wi), alpha_) : 0;
}

std::optional<Vec3f> BsdfClearcoat::sample(Vec3f to_viewer, Vec2f u) const {
  const Vec3f wo = frame_.local_from_world(to_viewer);
  if (!(wo.z > 0)) return std::nullopt;
  const Vec3f h = ggx::sample_visible_normal(wo, alpha_, u);
  const Vec3f wi = 2 * dot(wo, h) * h - wo;
  return wi.z > 0 ? std::optional(normalize(frame_.world_from_local(wi))) : std::nullopt;
}

float BsdfClearcoat::albedo(Vec3f direction) const {
  return strength_ * specular_albedo(std::abs(dot(direction, frame_.normal)), alpha_).at(kClearcoatF0);
}

float BsdfClearcoat::mean_albedo() const { return strength_ * mean_specular_albedo(alpha_).at(kClearcoatF0); }

float BsdfClearcoat::mean_below() const { return 1 - strength_ * mean_larger_clearcoat_albedo(alpha_); }

bool BsdfClearcoat::rough() const { return is_rough(alpha_); }

}  // namespace chiaro::renderer

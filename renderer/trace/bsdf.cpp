#include "renderer/trace/bsdf.h"

#include "renderer/core/sampler.h"
#include "renderer/trace/ggx.h"
#include "renderer/trace/specular_albedo.h"

namespace chiaro::renderer {
namespace {

constexpr float kDielectricF0 = 0.04F;
constexpr float kLeastAlpha = 1e-3F;  // a smaller one is a mirror to any eye and overflows D

}  // namespace

Bsdf::Bsdf(const SurfacePoint& point)
    : frame_(point.shading_normal),
      geometric_normal_(point.geometric_normal),
      smooth_normal_(point.smooth_normal),
      turned_(!(point.smooth_normal == point.shading_normal)),
      base_color_(point.base_color),
      metallic_(std::clamp(point.metallic, 0.0F, 1.0F)),
      alpha_(std::max(point.roughness * point.roughness, kLeastAlpha)),
      lambert_(point.lambert) {}

bool Bsdf::above_triangle(Vec3f direction) const { return dot(direction, geometric_normal_) > 0; }

bool Bsdf::above_horizon(Vec3f direction) const {
  return above_triangle(direction) || dot(direction, smooth_normal_) > 0;
}

float Bsdf::shadow_terminator(Vec3f to_light) const {
  if (!turned_) return 1;
  const float g = dot(smooth_normal_, to_light) / (dot(frame_.normal, to_light) * dot(smooth_normal_, frame_.normal));
  return g > 0 ? (g < 1 ? g * (1 + g - g * g) : 1) : 0;
}

Bsdf::Sketch Bsdf::sketch() const {
  const float color = max_component(base_color_);
  if (lambert_) return {color, 0, 1};
  return {(1 - metallic_) * color, (1 - metallic_) * kDielectricF0 + metallic_ * color, alpha_};
}

Vec3f Bsdf::eval(Vec3f to_viewer, Vec3f to_light) const {
  const Vec3f wo = frame_.local_from_world(to_viewer), wi = frame_.local_from_world(to_light);
  if (wo.z <= 0 || wi.z <= 0 || !above_horizon(to_light)) return {};
  const float fade = shadow_terminator(to_light);
  if (lambert_) return (fade * wi.z * kInvPi) * base_color_;
  const Vec3f h = normalize(wo + wi);
  const float weight = ggx::schlick_weight(dot(wo, h));
  const float specular = ggx::distribution(h.z, alpha_) * ggx::visibility(wo.z, wi.z, alpha_);
  const float fd = kDielectricF0 + (1 - kDielectricF0) * weight;
  const Vec3f fm = lerp(weight, base_color_, {1, 1, 1});
  // What the coat does not send back, in and out.
  const float below_o = 1 - specular_albedo(wo.z, alpha_).at(kDielectricF0);
  const float below_i = 1 - specular_albedo(wi.z, alpha_).at(kDielectricF0);
  const float below_mean = 1 - mean_specular_albedo(alpha_).at(kDielectricF0);
  const Vec3f dielectric =
      (fade * below_o * below_i / below_mean * kInvPi) * base_color_ + Vec3f{1, 1, 1} * (fd * specular);
  return wi.z * lerp(metallic_, dielectric, specular * fm);
}

float Bsdf::specular_probability(Vec3f wo) const {
  if (lambert_) return 0;
  const SpecularAlbedo albedo = specular_albedo(wo.z, alpha_);
  const float coat = albedo.at(kDielectricF0), metal = albedo.at(luminance(base_color_));
  const float specular = (1 - metallic_) * coat + metallic_ * metal;
  const float diffuse = (1 - metallic_) * (1 - coat) * luminance(base_color_);
  return specular + diffuse > 0 ? std::clamp(specular / (specular + diffuse), 0.1F, 1.0F) : 1.0F;
}

float Bsdf::pdf(Vec3f to_viewer, Vec3f to_light) const {
  const Vec3f wo = frame_.local_from_world(to_viewer), wi = frame_.local_from_world(to_light);
  if (wo.z <= 0 || wi.z <= 0 || !above_triangle(to_light)) return 0;
  const float specular = specular_probability(wo);
  float pdf = (1 - specular) * wi.z * kInvPi;
  if (specular > 0) pdf += specular * ggx::reflection_pdf(wo, normalize(wo + wi), alpha_);
  return pdf;
}

std::optional<Bsdf::Sample> Bsdf::sample(Vec3f to_viewer, Vec2f u, float lobe) const {
  const Vec3f wo = frame_.local_from_world(to_viewer);
  if (wo.z <= 0) return std::nullopt;
  Vec3f wi;
  if (lobe < specular_probability(wo)) {
    const Vec3f h = ggx::sample_visible_normal(wo, alpha_, u);
    wi = 2 * dot(wo, h) * h - wo;
  } else {
    wi = sample_cosine_hemisphere(u);
  }
  if (wi.z <= 0) return std::nullopt;
  Sample s;
  s.direction = normalize(frame_.world_from_local(wi));
  if (lambert_) {
    if (!above_triangle(s.direction)) return std::nullopt;
    s.pdf = wi.z * kInvPi;
    s.weight = shadow_terminator(s.direction) * base_color_;
    return s.pdf > 0 ? std::optional(s) : std::nullopt;
  }
  s.pdf = pdf(to_viewer, s.direction);
  if (!(s.pdf > 0)) return std::nullopt;
  s.weight = eval(to_viewer, s.direction) / s.pdf;
  return s;
}

Vec3f hemispherical_albedo(const SurfacePoint& point) {
  if (point.lambert) return point.base_color;
  const float metallic = std::clamp(point.metallic, 0.0F, 1.0F);
  const SpecularAlbedo albedo = mean_specular_albedo(std::max(point.roughness * point.roughness, kLeastAlpha));
  const float coat = albedo.at(kDielectricF0);
  const Vec3f dielectric = Vec3f{coat, coat, coat} + (1 - coat) * point.base_color;
  const Vec3f metal = albedo.scale * point.base_color + Vec3f{1, 1, 1} * albedo.bias;
  return lerp(metallic, dielectric, metal);
}

}  // namespace chiaro::renderer

#include "renderer/trace/bsdf.h"

#include "renderer/core/sampler.h"

namespace chiaro::renderer {
namespace {

constexpr float kDielectricF0 = 0.04F;
constexpr float kLeastAlpha = 1e-3F;  // a smaller one is a mirror to any eye and overflows D

float schlick_weight(float cosine) {
  const float m = std::clamp(1 - cosine, 0.0F, 1.0F);
  return m * m * m * m * m;
}

float ggx_d(float cosine_h, float alpha) {
  const float a2 = alpha * alpha;
  const float d = cosine_h * cosine_h * (a2 - 1) + 1;
  return a2 / (kPi * d * d);
}

// V = G / (4 cosθ_i cosθ_o), height-correlated Smith.
float smith_v(float cosine_o, float cosine_i, float alpha) {
  const float a2 = alpha * alpha;
  const float go = cosine_i * std::sqrt(cosine_o * cosine_o * (1 - a2) + a2);
  const float gi = cosine_o * std::sqrt(cosine_i * cosine_i * (1 - a2) + a2);
  return 0.5F / std::max(go + gi, 1e-20F);
}

float smith_g1(float cosine, float alpha) {
  const float a2 = alpha * alpha;
  return 2 * cosine / (cosine + std::sqrt(cosine * cosine * (1 - a2) + a2));
}

// Half vectors by the density of those visible from wo. Source: Dupuy & Benyoub, Sampling Visible GGX Normals with
// Spherical Caps, 2023.
Vec3f sample_visible_normal(Vec3f wo, float alpha, Vec2f u) {
  const Vec3f stretched = normalize(Vec3f{alpha * wo.x, alpha * wo.y, wo.z});
  const float phi = 2 * kPi * u.x;
  const float z = (1 - u.y) * (1 + stretched.z) - stretched.z;
  const float sine = std::sqrt(std::clamp(1 - z * z, 0.0F, 1.0F));
  const Vec3f h = Vec3f{sine * std::cos(phi), sine * std::sin(phi), z} + stretched;
  return normalize(Vec3f{alpha * h.x, alpha * h.y, std::max(h.z, 1e-6F)});
}

float visible_normal_reflection_pdf(Vec3f wo, Vec3f h, float alpha) {
  return smith_g1(wo.z, alpha) * ggx_d(h.z, alpha) / (4 * wo.z);
}

}  // namespace

Bsdf::Bsdf(const SurfacePoint& point)
    : frame_(point.shading_normal),
      geometric_normal_(point.geometric_normal),
      base_color_(point.base_color),
      metallic_(std::clamp(point.metallic, 0.0F, 1.0F)),
      alpha_(std::max(point.roughness * point.roughness, kLeastAlpha)),
      lambert_(point.lambert) {}

bool Bsdf::above_horizon(Vec3f direction) const { return dot(direction, geometric_normal_) > 0; }

Vec3f Bsdf::eval(Vec3f to_viewer, Vec3f to_light) const {
  const Vec3f wo = frame_.local_from_world(to_viewer), wi = frame_.local_from_world(to_light);
  if (wo.z <= 0 || wi.z <= 0 || !above_horizon(to_light)) return {};
  if (lambert_) return (wi.z * kInvPi) * base_color_;
  const Vec3f h = normalize(wo + wi);
  const float weight = schlick_weight(dot(wo, h));
  const float specular = ggx_d(h.z, alpha_) * smith_v(wo.z, wi.z, alpha_);
  const float fd = kDielectricF0 + (1 - kDielectricF0) * weight;
  const Vec3f fm = lerp(weight, base_color_, {1, 1, 1});
  const Vec3f dielectric = ((1 - fd) * kInvPi) * base_color_ + Vec3f{1, 1, 1} * (fd * specular);
  return wi.z * lerp(metallic_, dielectric, specular * fm);
}

float Bsdf::specular_probability(Vec3f wo) const {
  if (lambert_) return 0;
  const float weight = schlick_weight(wo.z);
  const float fd = kDielectricF0 + (1 - kDielectricF0) * weight;
  const float specular = lerp(metallic_, {fd, fd, fd}, lerp(weight, base_color_, {1, 1, 1})).y;
  const float diffuse = (1 - metallic_) * (1 - fd) * luminance(base_color_);
  return specular + diffuse > 0 ? std::clamp(specular / (specular + diffuse), 0.1F, 1.0F) : 1.0F;
}

float Bsdf::pdf(Vec3f to_viewer, Vec3f to_light) const {
  const Vec3f wo = frame_.local_from_world(to_viewer), wi = frame_.local_from_world(to_light);
  if (wo.z <= 0 || wi.z <= 0) return 0;
  const float specular = specular_probability(wo);
  float pdf = (1 - specular) * wi.z * kInvPi;
  if (specular > 0) pdf += specular * visible_normal_reflection_pdf(wo, normalize(wo + wi), alpha_);
  return pdf;
}

std::optional<Bsdf::Sample> Bsdf::sample(Vec3f to_viewer, Vec2f u, float lobe) const {
  const Vec3f wo = frame_.local_from_world(to_viewer);
  if (wo.z <= 0) return std::nullopt;
  Vec3f wi;
  if (lobe < specular_probability(wo)) {
    const Vec3f h = sample_visible_normal(wo, alpha_, u);
    wi = 2 * dot(wo, h) * h - wo;
  } else {
    wi = sample_cosine_hemisphere(u);
  }
  if (wi.z <= 0) return std::nullopt;
  Sample s;
  s.direction = normalize(frame_.world_from_local(wi));
  if (lambert_) {
    if (!above_horizon(s.direction)) return std::nullopt;
    s.pdf = wi.z * kInvPi;
    s.weight = base_color_;
    return s.pdf > 0 ? std::optional(s) : std::nullopt;
  }
  s.pdf = pdf(to_viewer, s.direction);
  if (!(s.pdf > 0)) return std::nullopt;
  s.weight = eval(to_viewer, s.direction) / s.pdf;
  return s;
}

Vec3f hemispherical_albedo(const SurfacePoint& point) {
  if (point.lambert) return point.base_color;
  SurfacePoint flat = point;
  flat.geometric_normal = flat.shading_normal = {0, 0, 1};
  const Bsdf bsdf(flat);
  // Stratified over the viewer's cosine and the lobe: a mean over a diffuse sky needs no more.
  constexpr int kStrata = 8;
  Vec3f sum;
  for (int i = 0; i < kStrata; ++i) {
    const Vec3f wo = sample_cosine_hemisphere({(float(i) + 0.5F) / kStrata, 0});
    for (int j = 0; j < kStrata; ++j) {
      const std::uint32_t k = std::uint32_t(i * kStrata + j);
      const Vec2f u{(float(j) + 0.5F) / kStrata, unit_float(reverse_bits(k))};
      const float lobe = unit_float(reverse_bits(k * 7U + 3U));
      if (const auto s = bsdf.sample(wo, u, lobe)) sum += s->weight;
    }
  }
  return min(sum / float(kStrata * kStrata), {1, 1, 1});
}

}  // namespace chiaro::renderer

#include "renderer/trace/bsdf_base.h"

#include "renderer/core/sampler.h"
#include "renderer/trace/boundary_albedo.h"
#include "renderer/trace/ggx_transmission.h"
#include "renderer/trace/specular_albedo.h"

namespace chiaro::renderer {
namespace {

constexpr Vec3f kWhite{1, 1, 1};
constexpr float kLeastAlpha = 1e-3F;     // a smaller one is a mirror to any eye and overflows D
constexpr float kPunctualAlpha = 5e-3F;  // a lamp of 1 cm at a metre
constexpr float kBlurredAlpha = 0.1F;

// What is lost of light from one direction, spread evenly over others by what is lost from them. Per cosine.
float spread_loss(float from, float to, float mean) {
  return kInvPi * std::max(0.0F, from * to) / std::max(1e-6F, mean);
}

// Of light from or to directions of these cosines, per cosine: what facets that scatter once lose of it, spread evenly.
float lost_by_scattering_once(float from, float to, float alpha) {
  return spread_loss(specular_albedo(from, alpha).loss(), specular_albedo(to, alpha).loss(),
                     mean_specular_albedo(alpha).loss());
}

}  // namespace

float least_alpha(float roughness) { return std::max(roughness * roughness, kLeastAlpha); }

float widened_alpha(float alpha, LightSource source) {
  if (source == LightSource::kPunctualWidened) return std::max(alpha, kPunctualAlpha);
  return source == LightSource::kPunctualBlurred ? std::max(alpha, kBlurredAlpha) : alpha;
}

float widening_gain(float cosine, float alpha, float widened) {
  if (widened <= alpha) return 1;
  return (1 - specular_albedo(cosine, alpha).loss()) / (1 - specular_albedo(cosine, widened).loss());
}

bool is_rough(float alpha) { return alpha >= kBlurredAlpha; }

BsdfBase::BsdfBase(const SurfacePoint& point)
    : base_color_(point.base_color),
      metallic_(std::clamp(point.metallic, 0.0F, 1.0F)),
      alpha_(least_alpha(point.roughness)) {
  if (!point.layers) return;
  const SurfaceLayers& layers = *point.layers;
  const bool inside = layers.solid && !point.front;
  f90_ = layers.specular;
  f0_ = layers.specular * min(normal_reflectance(layers.ior) * layers.specular_color, kWhite);
  coat_f0_ = max_component(f0_);
  transmission_ = (1 - metallic_) * layers.transmission;
  diffusion_ = 1 - layers.transmission;
  clear_ = transmission_ > 0 && is_clear(point.roughness);
  if (layers.solid && bends(layers.ior)) eta_ = inside ? 1 / layers.ior : layers.ior;
  if (!loses_at_boundary()) return;
  near_loss_ = mean_boundary_loss(alpha_, eta_);
  far_loss_ = mean_boundary_loss(alpha_, 1 / eta_);
  // As of light that is scattered once, but no more than is reciprocal.
  lost_through_ = mean_boundary_transmittance(eta_) * std::min(1.0F, far_loss_ / std::max(1e-6F, near_loss_));
}

BsdfSketch BsdfBase::sketch() const {
  const float color = max_component(base_color_);
  return {(1 - metallic_) * diffusion_ * color, (1 - metallic_) * coat_f0_ + metallic_ * color, alpha_};
}

// What the coat sends back of all light from one direction.
float BsdfBase::coat(float cosine) const {
  if (seen_from_inside()) return max_component(dielectric_reflectance_of(cosine));
  return specular_albedo(cosine, alpha_).at(coat_f0_, f90_);
}

// Of light from everywhere. As much light goes out of a solid as into it, from η² of the directions.
float BsdfBase::mean_coat() const {
  if (!seen_from_inside()) return mean_specular_albedo(alpha_).at(coat_f0_, f90_);
  constexpr int kSteps = 32;  // of the squared cosine
  float let_in = 0;
  for (int k = 0; k < kSteps; ++k) {
    let_in += (1 - dielectric_reflectance(std::sqrt((float(k) + 0.5F) / kSteps), 1 / eta_)) / kSteps;
  }
  const float least = normal_reflectance(eta_), weight = (1 - let_in * eta_ * eta_ - least) / (1 - least);
  return max_component(lerp(weight, f0_, f90_ * kWhite));
}

// The part of what facets of the metal lose by scattering once that more reflections bring out.
Vec3f BsdfBase::scattered_by_metal() const {
  constexpr float kMeanSchlickWeight = 1.0F / 21;
  const Vec3f mean = lerp(kMeanSchlickWeight, base_color_, kWhite);
  const float out = 1 - mean_specular_albedo(alpha_).loss();
  return mean * mean * out / (kWhite - (1 - out) * mean);
}

// Fresnel's equations, scaled so that they run from f0 to f90 as Schlick's formula does.
Vec3f BsdfBase::dielectric_reflectance_of(float cosine) const {
  float weight = schlick_weight(cosine);
  if (refracts()) {
    const float reflectance = dielectric_reflectance(cosine, eta_), least = normal_reflectance(eta_);
    if (reflectance >= 1) return kWhite;
    weight = std::max(0.0F, (reflectance - least) / (1 - least));
  }
  return lerp(weight, f0_, f90_ * kWhite);
}

// `cosine`: of the directions with the half vector.
Vec3f BsdfBase::facet_reflectance(float cosine) const {
  const Vec3f metal = lerp(schlick_weight(cosine), base_color_, kWhite);
  return lerp(metallic_, dielectric_reflectance_of(cosine), metal);
}

// Without the base colour.
float BsdfBase::facet_transmittance(float cosine) const {
  if (!transmits()) return 0;
  return transmission_ * (1 - max_component(dielectric_reflectance_of(cosine)));
}

Vec3f BsdfBase::reflection(Vec3f wo, Vec3f wi, float alpha, float diffuse_fade) const {
  const Vec3f h = normalize(wo + wi);
  const float specular = ggx::distribution(h, alpha) * ggx::visibility(wo.z, wi.z, alpha);
  const Vec3f facets = (widening_gain(wo.z, alpha_, alpha) * specular) * facet_reflectance(dot(wo, h));
  Vec3f diffuse{};
  if (metallic_ < 1 && diffusion_ > 0) {
    const float below_mean = 1 - mean_coat();
    const float below = below_mean > 0 ? (1 - coat(wo.z)) * (1 - coat(wi.z)) / below_mean : 0;
    diffuse += ((1 - metallic_) * diffusion_ * below * kInvPi) * base_color_;
  }
  if (metallic_ > 0) diffuse += (metallic_ * lost_by_scattering_once(wo.z, wi.z, alpha_)) * scattered_by_metal();
  if (loses_at_boundary()) {
    const float lost = spread_loss(boundary_loss(wo.z, alpha_, eta_), boundary_loss(wi.z, alpha_, eta_), near_loss_);
    diffuse += (transmission_ * (1 - lost_through_) * lost) * kWhite;
  }
  return wi.z * (diffuse_fade * diffuse + facets);
}

Vec3f BsdfBase::transmission(Vec3f wo, Vec3f wi, LightSource source) const {
  if (goes_straight()) return {};
  if (refracts()) {
    if (clear_ && source != LightSource::kExtended) return {};
    const ggx::Transmission t = ggx::refraction(wo, wi, widened_alpha(alpha_, source), eta_);
    const float once = t.value > 0 ? facet_transmittance(dot(wo, t.half)) * t.value : 0;
    if (!loses_at_boundary()) return once * base_color_;
    const float lost =
        spread_loss(boundary_loss(wo.z, alpha_, eta_), boundary_loss(-wi.z, alpha_, 1 / eta_), far_loss_);
    return (once - transmission_ * lost_through_ * lost * wi.z / (eta_ * eta_)) * base_color_;
  }
  const ggx::Transmission t = ggx::thin_transmission(wo, wi, widened_alpha(alpha_, source));
  const float lost = lost_by_scattering_once(wo.z, -wi.z, alpha_);
  return (facet_transmittance(dot(wo, t.half)) * t.value - transmission_ * lost * wi.z) * base_color_;
}

Vec3f BsdfBase::eval(Vec3f wo, Vec3f wi, LightSource source, float diffuse_fade) const {
  if (wi.z > 0) return reflection(wo, wi, widened_alpha(alpha_, source), diffuse_fade);
  return transmits() && wi.z < 0 ? transmission(wo, wi, source) : Vec3f{};
}

BsdfBase::Weights BsdfBase::weights(Vec3f wo) const {
  const SpecularAlbedo albedo = specular_albedo(wo.z, alpha_);
  const float sent_back = coat(wo.z), metal = albedo.at(luminance(base_color_));
  const float below = (1 - sent_back) * luminance(base_color_);
  Weights w;
  w.facets = (1 - metallic_) * sent_back + metallic_ * metal;
  w.diffuse = (1 - metallic_) * diffusion_ * below;
  if (metallic_ > 0) w.diffuse += metallic_ * std::max(0.0F, albedo.loss()) * luminance(scattered_by_metal());
  if (!transmits()) return w;
  if (goes_straight()) {
    w.straight = transmission_ * below;
  } else {
    w.facets += transmission_ * below;
    if (loses_at_boundary()) {
      const float lost = transmission_ * boundary_loss(wo.z, alpha_, eta_);
      w.facets = std::max(0.0F, w.facets - lost);
      w.diffuse += lost * (1 - lost_through_);
      w.diffuse_transmission = lost * lost_through_ * luminance(base_color_);
    } else if (!refracts()) {
      w.diffuse_transmission = transmission_ * std::max(0.0F, albedo.loss()) * luminance(base_color_);
    }
  }
  return w;
}

// That a facet which is seen from `cosine` reflects, and does not let through.
float BsdfBase::reflect_probability(float cosine) const {
  if (!transmits() || goes_straight()) return 1;
  const float reflected = luminance(facet_reflectance(cosine));
  const float through = facet_transmittance(cosine) * luminance(base_color_);
  return reflected + through > 0 ? reflected / (reflected + through) : 1;
}

float BsdfBase::pdf(Vec3f wo, Vec3f wi) const {
  const Weights w = weights(wo);
  const float total = w.total();
  const float facets = total > 0 ? w.facets / total : 1;
  if (wi.z > 0) {
    const Vec3f h = normalize(wo + wi);
    const float specular = reflect_probability(dot(wo, h)) * ggx::reflection_pdf(wo, h, alpha_);
    return facets * specular + (total > 0 ? w.diffuse / total : 0) * wi.z * kInvPi;
  }
  if (!transmits() || goes_straight() || !(wi.z < 0)) return 0;
  const ggx::Transmission t =
      refracts() ? ggx::refraction(wo, wi, alpha_, eta_) : ggx::thin_transmission(wo, wi, alpha_);
  const float through = t.pdf > 0 ? (1 - reflect_probability(dot(wo, t.half))) * t.pdf : 0;
  return facets * through - (total > 0 ? w.diffuse_transmission / total : 0) * wi.z * kInvPi;
}

std::optional<BsdfBase::Sample> BsdfBase::sample(Vec3f wo, Vec2f u, float lobe) const {
  const Weights w = weights(wo);
  const float total = w.total();
  float pick = lobe * total;
  if (pick < w.facets || !(total > 0)) {
    const Vec3f h = ggx::sample_visible_normal(wo, alpha_, u);
    const float cosine = dot(wo, h);
    const bool rough = is_rough(alpha_);
    const bool reflects = !(total > 0) || pick < w.facets * reflect_probability(cosine);
    const Vec3f reflected = 2 * cosine * h - wo;
    if (reflects) return reflected.z > 0 ? std::optional(Sample{.direction = reflected, .rough = rough}) : std::nullopt;
    const Vec3f through = refracts() ? ggx::refract(wo, h, eta_) : ggx::mirrored(reflected);
    return through.z < 0 ? std::optional(Sample{.direction = through, .rough = rough}) : std::nullopt;
  }
  pick -= w.facets;
  if (pick < w.straight) return Sample{.direction = -wo, .straight = true, .probability = w.straight / total};
  pick -= w.straight;
  const Vec3f diffuse = sample_cosine_hemisphere(u);
  if (!(diffuse.z > 0)) return std::nullopt;
  return Sample{.direction = pick < w.diffuse || !transmits() ? diffuse : ggx::mirrored(diffuse)};
}

Vec3f BsdfBase::straight(Vec3f wo) const { return goes_straight() ? clear(wo) : Vec3f{}; }

// Both boundaries of a solid are crossed under the angle of the air.
Vec3f BsdfBase::clear(Vec3f wo) const {
  if (!clear_) return {};
  if (!refracts()) return facet_transmittance(wo.z) * base_color_;
  const float outer = std::max(eta_, 1 / eta_), least = normal_reflectance(outer);
  const float weight = std::max(0.0F, (dielectric_reflectance(wo.z, outer) - least) / (1 - least));
  return (transmission_ * (1 - max_component(lerp(weight, f0_, f90_ * kWhite)))) * base_color_;
}

Vec3f BsdfBase::hemispherical_reflectance() const {
  const SpecularAlbedo albedo = mean_specular_albedo(alpha_);
  const Vec3f facets = albedo.scale * f0_ + (f90_ * albedo.bias) * kWhite;
  const Vec3f dielectric = facets + (diffusion_ * (1 - albedo.at(coat_f0_, f90_))) * base_color_;
  const Vec3f metal = albedo.scale * base_color_ + albedo.bias * kWhite;
  const Vec3f with_metal = lerp(metallic_, dielectric, metal + std::max(0.0F, albedo.loss()) * scattered_by_metal());
  return with_metal + (transmission_ * near_loss_ * (1 - lost_through_)) * kWhite;
}

}  // namespace chiaro::renderer

#include "renderer/trace/bsdf.h"

#include "renderer/core/sampler.h"

namespace chiaro::renderer {
namespace {

bool has_layers(const SurfacePoint& point) {
  if (!point.layers || point.lambert) return false;
  const bool inside = point.layers->solid && !point.front;
  return !inside && (point.layers->clearcoat > 0 || max_component(point.layers->sheen_color) > 0);
}

}  // namespace

Bsdf::Bsdf(const SurfacePoint& point)
    : frame_(point.shading_normal),
      geometric_normal_(point.geometric_normal),
      smooth_normal_(point.smooth_normal),
      turned_(!(point.smooth_normal == point.shading_normal)),
      base_color_(point.unlit ? Vec3f{} : point.base_color),
      geometric_horizon_(point.geometric_horizon) {
  if (!point.lambert && !point.unlit) base_.emplace(point);
  if (has_layers(point)) layers_.emplace(Layers{BsdfSheen(point), BsdfClearcoat(point)});
}

bool Bsdf::sees(Vec3f direction, float local_z) const {
  if (sides_agree(direction, local_z)) return true;
  return !geometric_horizon_ && !transmits() && local_z > 0 && dot(direction, smooth_normal_) > 0;
}

Vec3f Bsdf::light_normal() const {
  const bool two_horizons = layers_ && layers_->clearcoat.present() && !(layers_->clearcoat.normal() == frame_.normal);
  return transmits() || two_horizons ? Vec3f{} : frame_.normal;
}

Bsdf::Sketch Bsdf::sketch() const {
  const float color = max_component(base_color_);
  if (!base_) return {color, 0, 1};
  if (light_normal() == Vec3f{}) return {};
  Sketch sketch = base_->sketch();
  if (layers_) {
    sketch.diffuse += layers_->sheen.albedo(1);
    if (layers_->clearcoat.present()) sketch.specular += layers_->clearcoat.albedo(frame_.normal);
  }
  return sketch;
}

float Bsdf::shadow_terminator(Vec3f to_light) const {
  if (!turned_) return 1;
  const float g = dot(smooth_normal_, to_light) / (dot(frame_.normal, to_light) * dot(smooth_normal_, frame_.normal));
  return g > 0 ? (g < 1 ? g * (1 + g - g * g) : 1) : 0;
}

// What sheen and clearcoat leave of the light of the base.
float Bsdf::below_layers(Vec3f to_viewer, Vec3f to_light) const {
  if (!layers_) return 1;
  const float o = std::abs(dot(to_viewer, frame_.normal)), i = std::abs(dot(to_light, frame_.normal));
  return layers_->clearcoat.below(to_viewer, to_light) * layers_->sheen.below(o, i);
}

Vec3f Bsdf::eval(Vec3f to_viewer, Vec3f to_light, LightSource source) const {
  const Vec3f below = eval_below_clearcoat(to_viewer, to_light, source);
  return has_clearcoat_towards(to_light) ? below + layers_->clearcoat.eval(to_viewer, to_light, source) : below;
}

Vec3f Bsdf::eval_below_clearcoat(Vec3f to_viewer, Vec3f to_light, LightSource source) const {
  const Vec3f wo = frame_.local_from_world(to_viewer), wi = frame_.local_from_world(to_light);
  if (wo.z <= 0 || !sees(to_light, wi.z)) return {};
  if (!base_) return wi.z > 0 ? (shadow_terminator(to_light) * wi.z * kInvPi) * base_color_ : Vec3f{};
  Vec3f value = base_->eval(wo, wi, source, wi.z > 0 ? shadow_terminator(to_light) : 1);
  if (!layers_) return value;
  value *= below_layers(to_viewer, to_light);
  if (layers_->sheen.present()) value += layers_->clearcoat.below(to_viewer, to_light) * layers_->sheen.eval(wo, wi);
  return value;
}

// Its normal is another than that of what it covers.
bool Bsdf::has_clearcoat_towards(Vec3f to_light) const {
  return layers_ && layers_->clearcoat.present() && sees(to_light, layers_->clearcoat.cosine(to_light));
}

Bsdf::Choice Bsdf::choice(Vec3f to_viewer, Vec3f wo) const {
  if (!layers_) return {};
  const float coat = layers_->clearcoat.present() ? layers_->clearcoat.albedo(to_viewer) : 0;
  const float sheen = (1 - coat) * layers_->sheen.albedo(wo.z);
  const float base = (1 - coat - sheen) * base_->albedo(wo);
  const float total = coat + sheen + base;
  return total > 0 ? Choice{coat / total, sheen / total} : Choice{};
}

float Bsdf::pdf(Vec3f to_viewer, Vec3f to_light) const {
  const Vec3f wo = frame_.local_from_world(to_viewer), wi = frame_.local_from_world(to_light);
  if (wo.z <= 0) return 0;
  const bool sides_agree_below = sides_agree(to_light, wi.z);
  if (!base_) return sides_agree_below && wi.z > 0 ? wi.z * kInvPi : 0;
  const Choice p = choice(to_viewer, wo);
  float pdf = 0;
  if (sides_agree_below) {
    pdf = p.base() * base_->pdf(wo, wi);
    if (p.sheen > 0) pdf += p.sheen * BsdfSheen::pdf(wi);
  }
  if (p.clearcoat > 0 && sides_agree(to_light, layers_->clearcoat.cosine(to_light))) {
    pdf += p.clearcoat * layers_->clearcoat.pdf(to_viewer, to_light);
  }
  return pdf;
}

std::optional<Bsdf::Sample> Bsdf::sample_lambert(Vec2f u) const {
  const Vec3f wi = sample_cosine_hemisphere(u);
  if (wi.z <= 0) return std::nullopt;
  Sample s{.direction = normalize(frame_.world_from_local(wi)), .weight = {}, .pdf = wi.z * kInvPi};
  if (!(dot(s.direction, geometric_normal_) > 0) || !(s.pdf > 0)) return std::nullopt;
  s.weight = shadow_terminator(s.direction) * base_color_;
  return s;
}

Bsdf::Sample Bsdf::straight_sample(Vec3f to_viewer, float probability) const {
  return {.direction = -to_viewer, .weight = straight(to_viewer) / probability, .straight = true};
}

std::optional<Bsdf::Sample> Bsdf::sample(Vec3f to_viewer, Vec2f u, float lobe) const {
  const Vec3f wo = frame_.local_from_world(to_viewer);
  if (wo.z <= 0) return std::nullopt;
  if (!base_) return sample_lambert(u);
  const Choice p = choice(to_viewer, wo);
  Sample s;
  if (lobe < p.clearcoat) {
    const auto direction = layers_->clearcoat.sample(to_viewer, u);
    if (!direction) return std::nullopt;
    s.direction = *direction;
    s.rough = layers_->clearcoat.rough();
  } else if (lobe < p.clearcoat + p.sheen) {
    s.direction = normalize(frame_.world_from_local(BsdfSheen::sample(u)));
  } else {
    const auto below = base_->sample(wo, u, std::min((lobe - p.clearcoat - p.sheen) / p.base(), 1 - 0x1p-24F));
    if (!below) return std::nullopt;
    if (below->straight) return straight_sample(to_viewer, p.base() * below->probability);
    s.direction = normalize(frame_.world_from_local(below->direction));
    s.rough = below->rough;
  }
  s.pdf = pdf(to_viewer, s.direction);
  if (!(s.pdf > 0)) return std::nullopt;
  s.weight = eval(to_viewer, s.direction) / s.pdf;
  return max_component(s.weight) > 0 ? std::optional(s) : std::nullopt;
}

Vec3f Bsdf::straight(Vec3f to_viewer) const {
  if (!transmits()) return {};
  const Vec3f wo = frame_.local_from_world(to_viewer);
  return wo.z > 0 ? below_layers(to_viewer, -to_viewer) * base_->straight(wo) : Vec3f{};
}

Vec3f Bsdf::clear(Vec3f to_viewer) const {
  if (!transmits()) return {};
  const Vec3f wo = frame_.local_from_world(to_viewer);
  return wo.z > 0 ? below_layers(to_viewer, -to_viewer) * base_->clear(wo) : Vec3f{};
}

Vec3f hemispherical_albedo(const SurfacePoint& point) {
  if (point.unlit) return {};
  if (point.lambert) return point.base_color;
  Vec3f albedo = BsdfBase(point).hemispherical_reflectance();
  if (!has_layers(point)) return albedo;
  const BsdfSheen sheen(point);
  const BsdfClearcoat coat(point);
  albedo = sheen.mean_albedo() + sheen.mean_below() * albedo;
  return coat.mean_albedo() * Vec3f{1, 1, 1} + coat.mean_below() * albedo;
}

}  // namespace chiaro::renderer

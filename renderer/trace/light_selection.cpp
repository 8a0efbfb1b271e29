#include "renderer/trace/light_selection.h"

#include <algorithm>

#include "renderer/core/cpu_dispatch.h"
#include "renderer/trace/light_sampling.h"

namespace chiaro::renderer {
namespace {

constexpr double kBelowOne = 1 - 1e-12;

LightBounds bounds_of(const PointLight& light) {
  LightBounds bounds;
  bounds.box.extend(light.position);
  bounds.intensity = max_component(light.intensity);
  return bounds;
}

LightBounds bounds_of(const SpotLight& light) {
  LightBounds bounds;
  bounds.box.extend(light.position);
  bounds.axis = light.direction;
  bounds.spread = light.inner_cone_angle;
  // A little wider: the tree must not leave out by rounding what sample_punctual lets through.
  bounds.emission = std::max(0.0F, light.outer_cone_angle - light.inner_cone_angle) + 1e-3F;
  bounds.intensity = max_component(light.intensity);
  return bounds;
}

// Of no intensity, so that they are not in the tree.
LightBounds bounds_of(const DirectionalLight&) { return {}; }
LightBounds bounds_of(const EnvironmentLight&) { return {}; }

std::vector<LightBounds> bounds_of(const Lights& lights) {
  std::vector<LightBounds> bounds;
  for (const Light& light : lights) {
    bounds.push_back(std::visit([](const auto& l) { return bounds_of(l); }, light));
  }
  return bounds;
}

// The zero vector stands for a surface that all sides matter of.
bool any_side(Vec3f normal) { return !(length_squared(normal) > 0); }

float least_cosine(Vec3f normal) { return any_side(normal) ? 1.0F : 0.0F; }

struct NoResponse {
  [[gnu::always_inline]] float operator()(Vec3f, float) const { return 1; }
};

// Lambert, and GGX with Schlick's Fresnel and without most of its shadowing.
class SketchResponse {
 public:
  SketchResponse(Vec3f normal, Vec3f to_viewer, const Bsdf::Sketch& surface)
      : normal_(normal),
        to_viewer_(to_viewer),
        diffuse_(std::max(surface.diffuse, kLeastDiffuse) * kInvPi),
        a2_(surface.alpha * surface.alpha),
        f0_(surface.specular),
        cosine_viewer_(std::max(dot(normal, to_viewer), kLeastCosine)) {}

  [[gnu::always_inline]] float operator()(Vec3f to_light, float cosine) const {
    const Vec3f sum = to_viewer_ + to_light;
    const float scale = 1 / std::sqrt(std::max(dot(sum, sum), 1e-12F));
    const float n_h = std::min(scale * dot(normal_, sum), 1.0F), v_h = std::min(scale * dot(to_viewer_, sum), 1.0F);
    const float t = n_h * n_h * (a2_ - 1) + 1, distribution = a2_ * kInvPi / std::max(t * t, 1e-20F);
    const float away = 1 - v_h, fresnel = f0_ + (1 - f0_) * (away * away) * (away * away) * away;
    return diffuse_ + 0.25F * distribution * fresnel / (cosine_viewer_ * std::max(cosine, kLeastCosine));
  }

 private:
  static constexpr float kLeastDiffuse = 0.02F, kLeastCosine = 0.1F;
  Vec3f normal_, to_viewer_;
  float diffuse_, a2_, f0_, cosine_viewer_;
};

struct Place {
  Vec3f point, normal;
};

// Irradiance as sample_punctual has it, times response(direction to the light, its cosine).
template <class Response>
[[gnu::always_inline]] inline void weigh_lanes_by(const std::vector<LightLanes>& lanes, const Place& at,
                                                  const Response& response, float* out) {
  constexpr float kLargest = 1e30F;
  const Vec3f p = at.point, n = at.normal;
  const float least = least_cosine(n);
  for (const LightLanes& l : lanes) {
    for (std::size_t k = 0; k < LightLanes::kCount; ++k) {
      const Vec3f d{l.x[k] - p.x, l.y[k] - p.y, l.z[k] - p.z};
      const float scale = 1 / std::sqrt(std::max(dot(d, d), 1e-30F));
      const float cosine = std::max(least, scale * dot(n, d));
      const Vec3f off_axis{scale * d.x + l.axis_x[k], scale * d.y + l.axis_y[k], scale * d.z + l.axis_z[k]};
      const float fall = std::min(1.0F, std::max(0.0F, (l.outer[k] - 0.5F * dot(off_axis, off_axis)) * l.fall[k]));
      const float irradiance = l.intensity[k] * cosine * (scale * scale) * (fall * fall);
      out[k] = std::min(irradiance * response(scale * d, cosine), kLargest);
    }
    out += LightLanes::kCount;
  }
}

CHIARO_DISPATCH void weigh_lanes(const std::vector<LightLanes>& lanes, const Place& at, float* out) {
  weigh_lanes_by(lanes, at, NoResponse{}, out);
}

CHIARO_DISPATCH void weigh_lanes(const std::vector<LightLanes>& lanes, const Place& at, const SketchResponse& response,
                                 float* out) {
  weigh_lanes_by(lanes, at, response, out);
}

}  // namespace

LightSelection::LightSelection(const Lights& lights, LightVisibility* visibility)
    : lights_(lights), visibility_(visibility), place_(lights.size(), 0) {
  LightTree tree(bounds_of(lights));
  for (const std::uint32_t light : tree.lights_in_order()) order_.push_back(light);
  placed_ = order_.size();
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (std::holds_alternative<DirectionalLight>(lights[i])) order_.push_back(i);
  }
  for (std::size_t k = 0; k < order_.size(); ++k) place_[order_[k]] = k;
  if (order_.size() > kWeighed) {
    tree_ = std::move(tree);
    return;
  }
  lanes_.resize((placed_ + kLanes - 1) / kLanes);
  groups_ = (order_.size() + kLanes - 1) / kLanes;
  for (std::size_t k = 0; k < lanes_.size() * kLanes; ++k) {
    const Light nothing = PointLight{};
    set_lane(k < placed_ ? lights[order_[k]] : nothing, k % kLanes, lanes_[k / kLanes]);
  }
}

void LightSelection::set_lane(const Light& light, std::size_t lane, LightLanes& lanes) {
  const auto* spot = std::get_if<SpotLight>(&light);
  const auto* point = std::get_if<PointLight>(&light);
  const Vec3f at = spot != nullptr ? spot->position : point->position;
  const SpotCone cone = spot != nullptr ? spot_cone(*spot) : SpotCone{{}, 1, 2};
  lanes.x[lane] = at.x, lanes.y[lane] = at.y, lanes.z[lane] = at.z;
  lanes.axis_x[lane] = cone.axis.x, lanes.axis_y[lane] = cone.axis.y, lanes.axis_z[lane] = cone.axis.z;
  lanes.outer[lane] = cone.outer;
  lanes.fall[lane] = 1 / cone.fall();
  lanes.intensity[lane] = max_component(spot != nullptr ? spot->intensity : point->intensity);
}

void LightSelection::record(std::size_t light, Vec3f point, Vec3f normal, bool seen) const {
  if (visibility_ == nullptr || !weighs_all()) return;
  visibility_->record(visibility_->part_of(point, normal), place_[light], seen);
}

void LightSelection::apply_visibility(Vec3f point, Vec3f normal, Weights& weights) const {
  if (visibility_ == nullptr) return;
  const float* factors = visibility_->factors(visibility_->part_of(point, normal)).data();
  for (std::size_t k = 0; k < groups_ * kLanes; ++k) weights.of_light[k] *= factors[k];
}

// Every light's weight is there; the sums are not.
void LightSelection::sum_groups(Weights& weights) const {
  weights.total = 0;
  for (std::size_t group = 0; group < groups_; ++group) {
    const float* w = &weights.of_light[group * kLanes];
    weights.of_group[group] = ((w[0] + w[1]) + (w[2] + w[3])) + ((w[4] + w[5]) + (w[6] + w[7]));
    weights.total += double(weights.of_group[group]);
  }
}

template <class Response>
void LightSelection::weigh_distant(Vec3f p, Vec3f n, const Response& response, Weights& weights) const {
  for (std::size_t k = placed_; k < groups_ * kLanes; ++k) weights.of_light[k] = 0;
  for (std::size_t k = placed_; k < order_.size(); ++k) {
    const Vec3f to_light = sample_punctual(lights_[order_[k]], p).to_light;
    weights.of_light[k] =
        distant_weight(order_[k], n) * response(to_light, std::max(least_cosine(n), dot(n, to_light)));
  }
}

void LightSelection::weigh(Vec3f point, Vec3f normal, Weights& weights) const {
  weigh_lanes(lanes_, {point, normal}, weights.of_light.data());
  weigh_distant(point, normal, NoResponse{}, weights);
  apply_visibility(point, normal, weights);
  sum_groups(weights);
}

void LightSelection::weigh(Vec3f point, Vec3f normal, Vec3f to_viewer, const Bsdf::Sketch& surface,
                           Weights& weights) const {
  if (surface.specular <= 0) return weigh(point, normal, weights);
  const SketchResponse response(normal, to_viewer, surface);
  weigh_lanes(lanes_, {point, normal}, response, weights.of_light.data());
  weigh_distant(point, normal, response, weights);
  apply_visibility(point, normal, weights);
  sum_groups(weights);
}

// Where the sum of the weights exceeds `at`.
LightSelection::Pick LightSelection::find(const Weights& weights, double at) const {
  std::size_t group = 0;
  double sum = 0;
  for (; group < groups_; ++group) {
    const double after = sum + double(weights.of_group[group]);
    if (at < after) break;
    sum = after;
  }
  if (group == groups_) return {};
  Pick last;
  for (std::size_t k = group * kLanes; k < (group + 1) * kLanes; ++k) {
    const double w = double(weights.of_light[k]);
    if (!(w > 0)) continue;
    last = {order_[k], float(w / weights.total)};
    sum += w;
    if (at < sum) break;
  }
  return last;
}

float LightSelection::distant_weight(std::size_t light, Vec3f normal) const {
  const PunctualSample s = sample_punctual(lights_[light], {});
  return std::max(least_cosine(normal), dot(normal, s.to_light)) * max_component(s.irradiance);
}

LightSelection::Pick LightSelection::pick(Vec3f point, Vec3f normal, double u) const {
  if (!weighs_all()) return pick_from_tree(point, normal, u);
  Weights weights;
  weigh(point, normal, weights);
  return find(weights, u * weights.total);
}

LightSelection::Pick LightSelection::pick(Vec3f point, Vec3f normal, Vec3f to_viewer, const Bsdf::Sketch& surface,
                                          double u) const {
  if (!weighs_all()) return pick_from_tree(point, normal, u);
  Weights weights;
  weigh(point, normal, to_viewer, surface, weights);
  return find(weights, u * weights.total);
}

// The tree, then the lights at infinity.
LightSelection::Pick LightSelection::pick_from_tree(Vec3f point, Vec3f normal, double u) const {
  const double tree_weight = double(tree_.importance(point, normal));
  double total = tree_weight;
  for (std::size_t k = placed_; k < order_.size(); ++k) total += double(distant_weight(order_[k], normal));
  if (!(total > 0)) return {};
  double at = u * total;
  if (at < tree_weight) {
    const auto found = tree_.pick(point, normal, std::min(at / tree_weight, kBelowOne));
    return found ? Pick{found->light, float(tree_weight / total * double(found->probability))} : Pick{};
  }
  at -= tree_weight;
  Pick last;
  for (std::size_t k = placed_; k < order_.size() && at >= 0; ++k) {
    const double w = double(distant_weight(order_[k], normal));
    if (!(w > 0)) continue;
    last = {order_[k], float(w / total)};
    at -= w;
  }
  return last;
}

float LightSelection::probability(std::size_t light, Vec3f point, Vec3f normal) const {
  double total = 0, own = 0;
  if (weighs_all()) {
    Weights weights;
    weigh(point, normal, weights);
    total = weights.total;
    own = order_.empty() ? 0 : double(weights.of_light[place_[light]]);
  } else {
    const double tree_weight = double(tree_.importance(point, normal));
    total = tree_weight;
    for (std::size_t k = placed_; k < order_.size(); ++k) total += double(distant_weight(order_[k], normal));
    own = place_[light] >= placed_ ? double(distant_weight(light, normal))
                                   : tree_weight * double(tree_.probability(std::uint32_t(light), point, normal));
  }
  return total > 0 ? float(own / total) : 0;
}

}  // namespace chiaro::renderer

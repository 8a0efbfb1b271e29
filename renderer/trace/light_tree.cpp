#include "renderer/trace/light_tree.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace chiaro::renderer {
namespace {

constexpr std::uint32_t kNone = ~0U;
constexpr int kBuckets = 12;
constexpr std::size_t kFew = 256;  // lights that splits are tried along all three axes for

// The cosine of max(0, a − b) and its sine, of angles from 0 to π.
float cosine_of_difference(float sin_a, float cos_a, float sin_b, float cos_b) {
  return cos_a > cos_b ? 1 : cos_a * cos_b + sin_a * sin_b;
}
float sine_of_difference(float sin_a, float cos_a, float sin_b, float cos_b) {
  return cos_a > cos_b ? 0 : sin_a * cos_b - cos_a * sin_b;
}
float sine_of(float cosine) { return std::sqrt(std::max(0.0F, 1 - cosine * cosine)); }

// The surface area orientation heuristic, eq. (1) of Conty Estevez & Kulla. Lights on a line have no surface: the
// squared diagonal stands in for it.
double cost_of(const LightBounds& b) {
  if (!(b.intensity > 0)) return 0;
  const double o = double(b.spread), w = std::min(o + double(b.emission), M_PI);
  const double directions = 2 * M_PI * (1 - std::cos(o)) +
                            M_PI / 2 * (2 * w * std::sin(o) - std::cos(o - 2 * w) - 2 * o * std::sin(o) + std::cos(o));
  return double(b.intensity) * directions * double(length_squared(b.box.extent()));
}

}  // namespace

class LightTree::Builder {
 public:
  Builder(const std::vector<LightBounds>& lights, LightTree& tree) : lights_(lights), tree_(tree) {
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
      if (lights[i].intensity > 0) order_.push_back(i);
    }
  }

  void run() {
    tree_.leaf_of_light_.assign(lights_.size(), kNone);
    if (order_.empty()) return;
    tree_.nodes_.reserve(2 * order_.size() - 1);
    build(0, order_.size(), 0);
  }

 private:
  struct Split {
    double cost = double(kInfinity);
    int axis = -1, bucket = 0;
  };

  LightBounds build(std::size_t first, std::size_t last, std::uint32_t parent) {
    const auto index = std::uint32_t(tree_.nodes_.size());
    tree_.nodes_.emplace_back();
    LightBounds bounds;
    if (last - first == 1) {
      bounds = lights_[order_[first]];
      tree_.nodes_[index].light = order_[first];
      tree_.leaf_of_light_[order_[first]] = index;
    } else {
      const std::size_t middle = split(first, last);
      bounds = build(first, middle, index);
      tree_.nodes_[index].second = std::uint32_t(tree_.nodes_.size());
      bounds = bounds_of_both(bounds, build(middle, last, index));
    }
    set_bounds(bounds, tree_.nodes_[index]);
    tree_.nodes_[index].parent = parent;
    return bounds;
  }

  static void set_bounds(const LightBounds& bounds, Node& node) {
    node.center = bounds.box.center();
    node.radius_squared = 0.25F * length_squared(bounds.box.extent());
    node.axis = bounds.axis;
    node.cos_spread = std::cos(bounds.spread);
    node.sin_spread = sine_of(node.cos_spread);
    node.cos_emission = bounds.emission >= kPi / 2 ? 0 : std::cos(bounds.emission);
    node.intensity = bounds.intensity;
    node.two_sided = bounds.two_sided;
    node.everywhere = bounds.spread >= kPi;
  }

  // Brings the lights into two groups; returns where the second begins.
  std::size_t split(std::size_t first, std::size_t last) {
    Box3f centers;
    for (std::size_t i = first; i < last; ++i) centers.extend(center_of(order_[i]));
    const Split best = best_split(first, last, centers);
    if (best.axis < 0) return first + (last - first) / 2;  // all in one place
    const auto middle = std::partition(order_.begin() + long(first), order_.begin() + long(last), [&](std::uint32_t i) {
      return bucket_of(i, centers, best.axis) <= best.bucket;
    });
    return std::size_t(middle - order_.begin());
  }

  Split best_split(std::size_t first, std::size_t last, const Box3f& centers) const {
    const Vec3f extent = centers.extent();
    const float longest = max_component(extent);
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(extent[axis] > 0) || (last - first > kFew && extent[axis] < longest)) continue;
      std::array<LightBounds, kBuckets> buckets{};
      for (std::size_t i = first; i < last; ++i) {
        LightBounds& bucket = buckets[std::size_t(bucket_of(order_[i], centers, axis))];
        bucket = bounds_of_both(bucket, lights_[order_[i]]);
      }
      improve(buckets, double(longest / extent[axis]), axis, best);
    }
    return best;
  }

  static void improve(const std::array<LightBounds, kBuckets>& buckets, double stretch, int axis, Split& best) {
    std::array<LightBounds, kBuckets> above;  // of this bucket and all after it
    above[kBuckets - 1] = buckets[kBuckets - 1];
    for (std::size_t b = kBuckets - 1; b-- > 0;) above[b] = bounds_of_both(buckets[b], above[b + 1]);
    LightBounds below;
    for (std::size_t b = 0; b + 1 < kBuckets; ++b) {
      below = bounds_of_both(below, buckets[b]);
      if (!(below.intensity > 0) || !(above[b + 1].intensity > 0)) continue;
      const double cost = stretch * (cost_of(below) + cost_of(above[b + 1]));
      if (cost < best.cost) best = {cost, axis, int(b)};
    }
  }

  Vec3f center_of(std::uint32_t light) const { return lights_[light].box.center(); }

  int bucket_of(std::uint32_t light, const Box3f& centers, int axis) const {
    const float at = (center_of(light)[axis] - centers.min[axis]) / (centers.max[axis] - centers.min[axis]);
    return std::min(int(at * kBuckets), kBuckets - 1);
  }

  const std::vector<LightBounds>& lights_;
  LightTree& tree_;
  std::vector<std::uint32_t> order_;
};

LightTree::LightTree(const std::vector<LightBounds>& lights) { Builder(lights, *this).run(); }

// Irradiance, lux, as if all of the node's lights stood in its middle, but faced the point, and the surface them, as
// much as the bounds allow (PBR 4, section 12.6.3).
float LightTree::importance(const Node& node, Vec3f point, Vec3f normal) {
  constexpr float kLargest = 1e30F;  // closer than floats can tell
  const Vec3f d = node.center - point;
  const float d2 = length_squared(d);
  if (d2 <= node.radius_squared) {
    return node.radius_squared > 0 ? std::min(node.intensity / node.radius_squared, kLargest) : 0;
  }
  const float scale = 1 / std::sqrt(d2);
  const float sin2_bounds = node.radius_squared / d2;  // of the angle that the sphere takes up, from its middle
  const float sin_bounds = std::sqrt(sin2_bounds), cos_bounds = std::sqrt(1 - sin2_bounds);
  float result = std::min(node.intensity / d2, kLargest);
  if (!node.everywhere) {
    float cosine = -scale * dot(node.axis, d);
    if (node.two_sided) cosine = std::abs(cosine);
    const float sine = sine_of(cosine);
    const float cos_a = cosine_of_difference(sine, cosine, node.sin_spread, node.cos_spread);
    const float sin_a = sine_of_difference(sine, cosine, node.sin_spread, node.cos_spread);
    const float facing = cosine_of_difference(sin_a, cos_a, sin_bounds, cos_bounds);
    if (facing <= node.cos_emission) return 0;
    result *= facing;
  }
  if (normal == Vec3f{}) return result;
  const float cosine = std::clamp(scale * dot(normal, d), -1.0F, 1.0F);
  return result * std::max(0.0F, cosine_of_difference(sine_of(cosine), cosine, sin_bounds, cos_bounds));
}

float LightTree::importance(Vec3f point, Vec3f normal) const {
  return nodes_.empty() ? 0 : importance(nodes_[0], point, normal);
}

std::vector<std::uint32_t> LightTree::lights_in_order() const {
  std::vector<std::uint32_t> lights;
  for (const Node& node : nodes_) {
    if (node.second == 0) lights.push_back(node.light);
  }
  return lights;
}

std::optional<LightTree::Pick> LightTree::pick(Vec3f point, Vec3f normal, double u) const {
  if (nodes_.empty()) return std::nullopt;
  double probability = 1;
  std::uint32_t index = 0;
  while (nodes_[index].second != 0) {
    const std::uint32_t first = index + 1, second = nodes_[index].second;
    const double a = double(importance(nodes_[first], point, normal));
    const double b = double(importance(nodes_[second], point, normal));
    if (!(a + b > 0)) return std::nullopt;
    const double share = a / (a + b);
    if (u < share) {
      u = std::min(u / share, 1 - 1e-12);
      probability *= share;
      index = first;
    } else {
      u = std::min((u - share) / (1 - share), 1 - 1e-12);
      probability *= 1 - share;
      index = second;
    }
  }
  if (!(importance(nodes_[index], point, normal) > 0)) return std::nullopt;
  return Pick{nodes_[index].light, float(probability)};
}

float LightTree::probability(std::uint32_t light, Vec3f point, Vec3f normal) const {
  if (nodes_.empty() || leaf_of_light_[light] == kNone) return 0;
  double probability = 1;
  std::uint32_t index = leaf_of_light_[light];
  if (!(importance(nodes_[index], point, normal) > 0)) return 0;
  while (index != 0) {
    const std::uint32_t parent = nodes_[index].parent, first = parent + 1, second = nodes_[parent].second;
    const double a = double(importance(nodes_[first], point, normal));
    const double b = double(importance(nodes_[second], point, normal));
    if (!(a + b > 0)) return 0;
    probability *= (index == first ? a : b) / (a + b);
    index = parent;
  }
  return float(probability);
}

}  // namespace chiaro::renderer

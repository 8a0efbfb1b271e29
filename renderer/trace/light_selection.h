#pragma once
// Which punctual light to ask at a surface point, where not all are asked.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "renderer/scene/light.h"
#include "renderer/trace/bsdf.h"
#include "renderer/trace/light_tree.h"
#include "renderer/trace/light_visibility.h"

namespace chiaro::renderer {

// Point and spot lights side by side, so that a group is weighed at once.
struct LightLanes {
  static constexpr std::size_t kCount = 8;
  float x[kCount], y[kCount], z[kCount], intensity[kCount];
  float axis_x[kCount], axis_y[kCount], axis_z[kCount];  // zero: sends all ways
  float outer[kCount], fall[kCount];                     // of spots: versine; 1 / (outer − inner)
};

// In proportion to the irradiance that a light would give if nothing stood between: exactly that among up to some
// hundred lights, as a light tree bounds it among more; and, among the former, to what shadow rays have learnt of what
// stands between. Environments are left to EnvironmentSampling.
class LightSelection {
 public:
  // Up to so many lights all are asked where a surface is seen directly.
  static constexpr std::size_t kFew = 4;
  // Up to so many lights all are weighed. (Weighing four takes about as long as one step down the tree.)
  static constexpr std::size_t kWeighed = 256;

  // Keeps references to both, which must outlive it. visibility: nullptr where nothing is learnt.
  explicit LightSelection(const Lights& lights, LightVisibility* visibility = nullptr);
  bool few() const { return order_.size() <= kFew; }
  bool weighs_all() const { return order_.size() <= kWeighed; }

  struct Pick {
    std::size_t light = 0;
    float probability = 0;  // 0: none brings anything
  };
  // normal: of the surface; the zero vector stands for one that light goes through, here and below. 0 ≤ u < 1.
  // Neighbours in u are neighbours in space, so that stratified ones spread over the scene.
  Pick pick(Vec3f point, Vec3f normal, double u) const;
  // Where all are weighed: in proportion to about what the surface would send of the light to the viewer, too.
  Pick pick(Vec3f point, Vec3f normal, Vec3f to_viewer, const Bsdf::Sketch& surface, double u) const;
  // With which pick() gives the light.
  float probability(std::size_t light, Vec3f point, Vec3f normal) const;

  // A shadow ray from there to the light, for what is learnt.
  void record(std::size_t light, Vec3f point, Vec3f normal, bool seen) const;

  // What lights would bring to a point, one by one, and in groups.
  static constexpr std::size_t kLanes = LightLanes::kCount;
  static_assert(kLanes == LightVisibility::kLanes);
  struct Weights {
    std::array<float, kWeighed + kLanes> of_light;  // in the order of lights_in_order(), padded with zeros
    std::array<float, kWeighed / kLanes + 1> of_group;
    double total = 0;
  };
  // Where all are weighed: irradiance from the side of `normal`, lux of the brightest channel.
  void weigh(Vec3f point, Vec3f normal, Weights& weights) const;
  // The same times about what the surface would send of it to the viewer; above zero wherever the irradiance is.
  void weigh(Vec3f point, Vec3f normal, Vec3f to_viewer, const Bsdf::Sketch& surface, Weights& weights) const;
  std::span<const std::size_t> lights_in_order() const { return order_; }

 private:
  static void set_lane(const Light& light, std::size_t lane, LightLanes& lanes);
  template <class Response>
  void weigh_distant(Vec3f point, Vec3f normal, const Response& response, Weights& weights) const;
  void apply_visibility(Vec3f point, Vec3f normal, Weights& weights) const;
  void sum_groups(Weights& weights) const;
  Pick find(const Weights& weights, double at) const;
  float distant_weight(std::size_t light, Vec3f normal) const;
  Pick pick_from_tree(Vec3f point, Vec3f normal, double u) const;

  const Lights& lights_;
  LightVisibility* visibility_;
  std::vector<std::size_t> order_;  // punctual lights, neighbours together, then those at infinity
  std::vector<std::size_t> place_;  // per light, in order_
  std::size_t placed_ = 0;          // lights with a position
  std::size_t groups_ = 0;
  std::vector<LightLanes> lanes_;  // of those with a position
  LightTree tree_;
};

}  // namespace chiaro::renderer

#pragma once
// One light out of many, picked by what each may bring to a surface point: distance, the way the light faces, and the
// way the surface faces.
//
// A binary tree over the lights. Each node bounds where its lights are (a box), which ways they face (a cone of axes,
// each sending light up to an angle from it) and adds up what they send. A pick goes down from the root, by the bounds
// of the two children; no light that can reach the point is left out. Source: Conty Estevez & Kulla, Importance
// Sampling of Many Lights with Adaptive Tree Splitting, 2018 (without the splitting); Pharr, Jakob, Humphreys,
// Physically Based Rendering, 4th edition, 2023, section 12.6.3.

#include <cstdint>
#include <optional>
#include <vector>

#include "renderer/core/vec.h"

namespace chiaro::renderer {

// What is known of a light, or of some.
struct LightBounds {
  Box3f box;                 // of their points, world
  Vec3f axis{0, 0, 1};       // unit; the middle of the ways that they face
  float spread = kPi;        // radians from it, within which all face
  float emission = kPi / 2;  // radians from the way it faces, up to which a light sends
  bool two_sided = false;    // they send the opposite way too
  float intensity = 0;       // candela, of all together, the way each faces
};

LightBounds bounds_of_both(const LightBounds& a, const LightBounds& b);

class LightTree {
 public:
  LightTree() = default;
  // Lights of no intensity are never picked.
  explicit LightTree(const std::vector<LightBounds>& lights);
  bool empty() const { return nodes_.empty(); }

  struct Pick {
    std::uint32_t light = 0;
    float probability = 0;
  };
  // For a surface of this normal; the zero vector stands for one that all sides matter of. 0 ≤ u < 1. Absent where the
  // walk ends among lights that cannot reach the point, which happens with a probability of its own.
  std::optional<Pick> pick(Vec3f point, Vec3f normal, double u) const;
  // With which pick() gives the light.
  float probability(std::uint32_t light, Vec3f point, Vec3f normal) const;

  // All that can be picked, neighbours in the tree together.
  std::vector<std::uint32_t> lights_in_order() const;

  // Irradiance, lux, that all lights together are expected to bring to the point at most, as far as the root can tell.
  float importance(Vec3f point, Vec3f normal) const;

 private:
  struct Node {
    Vec3f center;
    float radius_squared = 0;  // of the sphere around the box
    Vec3f axis;
    float cos_spread = -1, sin_spread = 0, cos_emission = 0;
    float intensity = 0;
    bool two_sided = false, everywhere = false;  // everywhere: sends all ways
    std::uint32_t parent = 0;
    std::uint32_t second = 0;  // inner nodes: the second child, the first is the next node; 0: a leaf
    std::uint32_t light = 0;   // leaves
  };
  class Builder;

  static float importance(const Node& node, Vec3f point, Vec3f normal);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> leaf_of_light_;  // kNone: of no intensity
};

}  // namespace chiaro::renderer

#pragma once
// Light arriving at a point from punctual lights and from the scene's emissive triangles.

#include <cmath>
#include <cstdint>
#include <vector>

#include "renderer/scene/light.h"
#include "renderer/trace/light_tree.h"
#include "renderer/trace/ray_tracer.h"
#include "renderer/trace/triangle_extent.h"

namespace chiaro::renderer {

// What a punctual light sends to a point, before anything stands between.
struct PunctualSample {
  Vec3f to_light;      // unit
  float distance = 0;  // metres; infinite for directional lights
  Vec3f irradiance;    // lux / cd·m⁻² per channel on a plane across to_light: intensity / distance²
};

// 1 − cos of an angle, which narrow cones are told apart by where their cosines are all 1 in floats; of the angle
// between two unit vectors.
inline float versine(float angle) { return 2 * std::sin(angle / 2) * std::sin(angle / 2); }
inline float versine(Vec3f a, Vec3f b) { return 0.5F * length_squared(a - b); }

// A spot's light by the angle from its axis: KHR_lights_punctual's recommended falloff.
struct SpotCone {
  Vec3f axis;          // unit, from the light outwards
  float inner, outer;  // versines

  struct Falloff {
    float value, derivative;  // 1 within the inner cone; by the versine
  };
  Falloff falloff(float versine) const;
  float fall() const;  // of versines, from the inner cone to the outer
};
SpotCone spot_cone(const SpotLight& light);

// Nothing from an environment, which is no punctual light.
PunctualSample sample_punctual(const Light& light, Vec3f point);

// Rays that leave point and spot lights, chosen by power. Other lights send none.
class PunctualEmission {
 public:
  // Keeps a reference to `lights`, which must outlive it.
  explicit PunctualEmission(const Lights& lights);
  bool empty() const { return power_end_.empty() || !(power_end_.back() > 0); }

  struct Sample {
    std::size_t light = 0;
    Vec3f origin, direction;  // unit
    Vec3f intensity;          // candela, that way
  };
  Sample sample(float pick, Vec2f u) const;
  // Density of sample() for a light and a unit direction from it: per steradian, times the light's probability.
  float pdf(std::size_t light, Vec3f direction) const;

 private:
  const Lights& lights_;
  std::vector<double> power_;      // lumens of the brightest channel; a float's range is too small for some
  std::vector<double> power_end_;  // cumulative
};

// The scene's emissive triangles, sampled by a light tree. Triangles send light from both of their sides.
class EmissiveTriangles {
 public:
  explicit EmissiveTriangles(const Scene& scene);
  bool empty() const { return triangles_.empty(); }

  struct Sample {
    Vec3f to_light;  // unit
    float distance = 0;
    float reach = 0;  // metres that a shadow ray goes: it does not meet the triangle itself
    Vec3f radiance;   // cd/m²
    float pdf = 0;    // per steradian, at the point
  };
  // At a surface of this normal, or of any where it is zero. 0 ≤ pick < 1. pdf 0: nothing arrives.
  Sample sample(Vec3f point, Vec3f normal, double pick, Vec2f u) const;
  // Density, per steradian, with which sample() finds this hit from a surface point.
  float pdf(const Hit& hit, Vec3f point, Vec3f normal, Vec3f hit_position) const;

 private:
  struct Emitter {
    std::uint32_t instance, triangle;
    Vec3f p0, p1, p2;  // world
    Vec3f normal;      // unit
    float area;        // m²
    TriangleExtent extent;
  };
  void add_instance(std::uint32_t instance, bool instanced, std::vector<LightBounds>& bounds);

  const Scene& scene_;
  std::vector<Emitter> triangles_;
  std::vector<std::vector<std::uint32_t>> emitter_;  // per instance and triangle; empty where nothing is emitted
  LightTree tree_;
};

}  // namespace chiaro::renderer

#pragma once
// Rays against the scene, through Embree. Immutable and thread-safe once built.

#include <cstdint>
#include <memory>
#include <optional>

#include "renderer/scene/scene.h"

namespace chiaro::renderer {

struct Ray {
  Vec3f origin;
  Vec3f direction;  // unit, unless near and far are meant in its length
  float near = 0, far = kInfinity;
  std::uint32_t alpha_seed = 0;  // decides which alpha-blended surfaces the ray passes: 1 − alpha of all seeds do
};

struct Hit {
  float distance = 0;  // in lengths of the direction
  float u = 0, v = 0;  // barycentric: point = (1 − u − v) p0 + u p1 + v p2
  std::uint32_t instance = 0, triangle = 0;
  Vec3f geometric_normal;  // unit, world, on the side of the triangle's winding; not flipped towards the ray
};

class RayTracer {
 public:
  // Keeps a reference to `scene`, which must outlive it. Error when memory runs out.
  explicit RayTracer(const Scene& scene);
  ~RayTracer();
  RayTracer(const RayTracer&) = delete;
  RayTracer& operator=(const RayTracer&) = delete;

  const Scene& scene() const { return scene_; }
  const Box3f& bounds() const { return bounds_; }  // world; of the drawn triangles

  std::optional<Hit> intersect(const Ray& ray) const;
  bool occluded(const Ray& ray) const;
  // Whether anything stands between two points, both already moved off their surfaces.
  bool occluded_between(Vec3f from, Vec3f to, std::uint32_t alpha_seed) const;

 private:
  struct Embree;
  const Scene& scene_;
  Box3f bounds_;
  std::unique_ptr<Embree> embree_;
};

// `point` moved off its surface to the side of `normal`, by a distance that float rounding at its magnitude calls for.
Vec3f offset_point(Vec3f point, Vec3f normal);

}  // namespace chiaro::renderer

#pragma once
// Light that passes clear surfaces (is_clear) without being turned: glass panes, bulbs, bottles. Through thin sheets
// this is what the material says. Through solids it is how shadow rays of punctual lights take them, since scattered
// rays, which are refracted, never meet a point: as if the boundary did not refract, with its reflection and what the
// inside absorbs.

#include <array>

#include "renderer/trace/ray_tracer.h"
#include "renderer/trace/surface_point.h"

namespace chiaro::renderer {

// On one ray; more let nothing through.
inline constexpr int kMostClearSurfaces = 1000;

// The solids that a point is inside of, as far as its path knows.
class Media {
 public:
  // Of a point that is on no surface: those that rays from there leave before they enter them, by most of the rays that
  // meet them at all. So an open surface, such as that of a lake, is as good as a closed one.
  static Media at(const RayTracer& tracer, Vec3f position);

  // Through the surface, by way of its boundary: into a solid from its front, out of it from its back.
  void cross(const SurfacePoint& surface);
  // What arrives over the last `distance` metres to `surface`. Behind the back of a boundary is its solid, whether the
  // path knows of it or not.
  Vec3f transmittance(const SurfacePoint& surface, float distance) const;
  // Of the innermost solid.
  Vec3f transmittance(float distance) const;
  bool empty() const { return count_ == 0; }

 private:
  struct Solid {
    int material = 0;
    Vec3f absorption;
  };
  void enter(const Solid& solid);

  static constexpr int kMost = 4;  // nested in each other; more do not absorb
  std::array<Solid, kMost> inside_;
  int count_ = 0;
};

// Of the light that comes along `ray`, which nothing but surfaces that its `clear` passes stand in the way of: that
// part which they, and the solids among them, let through. `media`: where the ray starts.
Vec3f clear_transmittance(const RayTracer& tracer, const Ray& ray, const Media& media);

bool has_clear_surfaces(const Scene& scene);
bool has_solids(const Scene& scene);

}  // namespace chiaro::renderer

#pragma once
// How large a triangle is in the numbers that rays meet it by: what its rounding grows with.

#include <array>
#include <cstdint>

#include "renderer/scene/scene.h"
#include "renderer/trace/ray_tracer.h"

namespace chiaro::renderer {

struct TriangleExtent {
  float largest_coordinate = 0;  // metres; of all terms of the sums that place it
  float circle_radius = 0;       // metres; of the circle through its corners, up to 16 of its longest edge
};

// corners: in the world. instanced: rays meet it in object space (Hit), as those of meshes that are drawn more than
// once.
TriangleExtent triangle_extent(const std::array<Vec3f, 3>& corners, const Mesh& mesh, std::uint32_t triangle,
                               const Mat4f& world_from_object, bool instanced);
// Of the triangle that a ray met.
TriangleExtent triangle_extent(const Scene& scene, const Hit& hit);

// How far rounding may take a point of the triangle off the plane that rays meet, metres.
inline float surface_rounding(const TriangleExtent& extent) {
  return surface_rounding(extent.largest_coordinate, extent.circle_radius);
}

// Of no triangle of the scene is either larger.
TriangleExtent largest_extent(const Scene& scene);

}  // namespace chiaro::renderer

#include "renderer/trace/triangle_extent.h"

#include <algorithm>

namespace chiaro::renderer {
namespace {

using Corners = std::array<Vec3f, 3>;

float largest_coordinate(const Corners& corners) {
  return max_component(max(max(abs(corners[0]), abs(corners[1])), abs(corners[2])));
}

// Of the sums that make corners' world coordinates, and a ray's object coordinates: the largest term may be far larger
// than the sum.
float largest_term(const Mesh& mesh, std::uint32_t triangle, const Mat4f& m) {
  float largest = 0;
  for (const std::uint32_t v : mesh.triangles[triangle]) {
    const Vec3f p = abs(mesh.positions[v]);
    largest = std::max(largest, max_component(p.x * abs(m.column(0)) + p.y * abs(m.column(1)) + p.z * abs(m.column(2)) +
                                              abs(m.column(3))));
  }
  return largest;
}

// Large where the corners lie almost on a line; then at most kMost edges.
float circle_radius(const Corners& corners) {
  constexpr float kMost = 16;
  const Vec3f ab = corners[1] - corners[0], bc = corners[2] - corners[1], ca = corners[0] - corners[2];
  const float a = length(bc), b = length(ca), c = length(ab), most = kMost * std::max({a, b, c});
  const float radius = a * b * c / (2 * length(cross(ab, ca)));
  return radius < most ? radius : most;
}

}  // namespace

TriangleExtent triangle_extent(const Corners& corners, const Mesh& mesh, std::uint32_t triangle,
                               const Mat4f& world_from_object, bool instanced) {
  return {instanced ? largest_term(mesh, triangle, world_from_object) : largest_coordinate(corners),
          circle_radius(corners)};
}

}  // namespace chiaro::renderer

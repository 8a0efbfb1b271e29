#include "renderer/trace/triangle_extent.h"

#include <algorithm>

namespace chiaro::renderer {
namespace {

using Corners = std::array<Vec3f, 3>;

constexpr float kMostEdges = 16;

float largest_coordinate(const Corners& corners) {
  return max_component(max(max(abs(corners[0]), abs(corners[1])), abs(corners[2])));
}

// Of the sums that make corners' world coordinates, and a ray's object coordinates: the largest term may be far larger
// than the sum.
float largest_term(Vec3f position, const Mat4f& m) {
  const Vec3f p = abs(position);
  return max_component(p.x * abs(m.column(0)) + p.y * abs(m.column(1)) + p.z * abs(m.column(2)) + abs(m.column(3)));
}

float largest_term(const Mesh& mesh, std::uint32_t triangle, const Mat4f& m) {
  float largest = 0;
  for (const std::uint32_t v : mesh.triangles[triangle])
    largest = std::max(largest, largest_term(mesh.positions[v], m));
  return largest;
}

// Large where the corners lie almost on a line.
float circle_radius(const Corners& corners) {
  const Vec3f ab = corners[1] - corners[0], bc = corners[2] - corners[1], ca = corners[0] - corners[2];
  const float a = length(bc), b = length(ca), c = length(ab), most = kMostEdges * std::max({a, b, c});
  const float radius = a * b * c / (2 * length(cross(ab, ca)));
  return radius < most ? radius : most;
}

}  // namespace

TriangleExtent triangle_extent(const Corners& corners, const Mesh& mesh, std::uint32_t triangle,
                               const Mat4f& world_from_object, bool instanced) {
  return {instanced ? largest_term(mesh, triangle, world_from_object) : largest_coordinate(corners),
          circle_radius(corners)};
}

TriangleExtent triangle_extent(const Scene& scene, const Hit& hit) {
  const Instance& instance = scene.instances[hit.instance];
  const Mesh& mesh = scene.meshes[instance.mesh];
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = transform_point(instance.world_from_object, mesh.positions[mesh.triangles[hit.triangle][k]]);
  }
  return triangle_extent(corners, mesh, hit.triangle, instance.world_from_object, hit.instanced);
}

TriangleExtent largest_extent(const Scene& scene) {
  std::vector<Vec3f> farthest;  // of each mesh, every coordinate by itself
  for (const Mesh& mesh : scene.meshes) {
    Vec3f& far = farthest.emplace_back();
    for (const Vec3f& p : mesh.positions) far = max(far, abs(p));
  }
  TriangleExtent largest{0, kMostEdges * bounds(scene).diagonal()};
  for (const Instance& instance : scene.instances) {
    largest.largest_coordinate =
        std::max(largest.largest_coordinate, largest_term(farthest[instance.mesh], instance.world_from_object));
  }
  return largest;
}

}  // namespace chiaro::renderer

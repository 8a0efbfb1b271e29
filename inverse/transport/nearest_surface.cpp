#include "inverse/transport/nearest_surface.h"

#include <Eigen/Geometry>

#include "inverse/numerics/closest_point.h"
#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {

using Eigen::Vector3d;

namespace {

// By the barycentric coordinates of a point on the triangle's rim or inside.
bool lies_on(const OpenEdges& open, const Vector3d& weights) {
  for (int k = 0; k < 3; ++k) {
    if (weights[k] == 1) return open.corner[k];
  }
  for (int k = 0; k < 3; ++k) {
    if (weights[k] == 0) return open.edge[k];
  }
  return false;
}

}  // namespace

NearestSurface::NearestSurface(const renderer::Scene& scene, const std::optional<std::string>& node) {
  std::vector<renderer::Box3f> boxes;
  for (const renderer::Instance& instance : scene.instances) {
    if (node && !belongs_to(scene, instance, *node)) continue;
    const renderer::Mesh& mesh = scene.meshes[instance.mesh];
    const bool double_sided = scene.materials[mesh.material].double_sided;
    const bool mirrored = determinant3(instance.world_from_object) < 0;
    for (const renderer::Triangle& triangle : mesh.triangles) {
      WorldTriangle& world = triangles_.emplace_back();
      world.double_sided = double_sided;
      renderer::Box3f& box = boxes.emplace_back();
      for (int k = 0; k < 3; ++k) {
        world.corners[k] = transform_point(instance.world_from_object, mesh.positions[triangle[k]]);
        box.extend(world.corners[k]);
      }
      if (mirrored) std::swap(world.corners[1], world.corners[2]);
    }
  }
  tree_ = make_box_tree(boxes);
  if (node) mark_open_edges();
}

void NearestSurface::mark_open_edges() {
  std::vector<WorldCorners> corners;
  for (const WorldTriangle& triangle : triangles_) corners.push_back(triangle.corners);
  const std::vector<OpenEdges> open = find_open_edges(corners);
  for (std::size_t t = 0; t < open.size(); ++t) triangles_[t].open = open[t];
}

NearestPoint NearestSurface::nearest_on(const WorldTriangle& triangle, const Vector3d& position) {
  const auto& [a, b, c] = triangle.corners;
  const numerics::TriangleCorners corners{to_eigen(a), to_eigen(b), to_eigen(c)};
  const Vector3d weights = numerics::closest_on_triangle(corners, position);
  NearestPoint nearest;
  nearest.point = weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
  nearest.normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  nearest.distance = (position - nearest.point).norm();
  nearest.double_sided = triangle.double_sided;
  nearest.on_open_edge = lies_on(triangle.open, weights);
  return nearest;
}

std::optional<NearestPoint> NearestSurface::find(const Vector3d& position, double reach) const {
  std::optional<NearestPoint> nearest;
  visit_near(tree_, to_vec3f(position), reach, [&](std::uint32_t item) {
    const NearestPoint here = nearest_on(triangles_[item], position);
    if (here.distance <= reach && (!nearest || here.distance < nearest->distance)) nearest = here;
    return nearest ? std::min(reach, nearest->distance) : reach;
  });
  return nearest;
}

}  // namespace chiaro::inverse

#pragma once
// How far a point is from a scene's surfaces, by trying all triangles. After Ericson, Real-Time Collision Detection,
// 2004, section 5.1.5: by the Voronoi regions of the triangle.

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include <Eigen/Core>

#include "inverse/transport/eigen_vectors.h"
#include "renderer/scene/scene.h"

namespace chiaro::test {

inline Eigen::Vector3d nearest_point_of(const std::array<Eigen::Vector3d, 3>& t, const Eigen::Vector3d& p) {
  const Eigen::Vector3d ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0], bp = p - t[1], cp = p - t[2];
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return t[0];
  if (d3 >= 0 && d4 <= d3) return t[1];
  if (d6 >= 0 && d5 <= d6) return t[2];
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return t[0] + d1 / (d1 - d3) * ab;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return t[0] + d2 / (d2 - d6) * ac;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return t[1] + (d4 - d3) / (d4 - d3 + d5 - d6) * (t[2] - t[1]);
  return t[0] + (vb * ab + vc * ac) / (va + vb + vc);
}

// Metres. node: its surfaces alone; empty: all.
inline double distance_to_surfaces(const renderer::Scene& scene, const Eigen::Vector3d& position,
                                   const std::string& node = {}) {
  double least = std::numeric_limits<double>::infinity();
  for (const renderer::Instance& instance : scene.instances) {
    if (!node.empty() && instance.name != node) continue;
    const renderer::Mesh& mesh = scene.meshes[instance.mesh];
    for (const renderer::Triangle& triangle : mesh.triangles) {
      std::array<Eigen::Vector3d, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = inverse::to_eigen(transform_point(instance.world_from_object, mesh.positions[triangle[k]]));
      }
      least = std::min(least, (position - nearest_point_of(corners, position)).norm());
    }
  }
  return least;
}

}  // namespace chiaro::test

#pragma once
// How far surfaces are from anywhere, and where the nearest is.

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "inverse/transport/box_tree.h"
#include "renderer/scene/scene.h"

namespace chiaro::inverse {

struct NearestPoint {
  Eigen::Vector3d point;   // on the surface, metres
  Eigen::Vector3d normal;  // unit, on the side of the triangle's winding; zero for a triangle without area
  double distance = 0;     // metres
  bool double_sided = false;
};

// Of all drawn surfaces of the scene, or those of the node's instances; empty where there are none.
renderer::Box3f surface_bounds(const renderer::Scene& scene, const std::optional<std::string>& node = {});

class NearestSurface {
 public:
  // All drawn surfaces of the scene, or those of the node's instances.
  explicit NearestSurface(const renderer::Scene& scene, const std::optional<std::string>& node = {});

  // None where all surfaces are farther than `reach` (metres).
  std::optional<NearestPoint> find(const Eigen::Vector3d& position, double reach) const;

 private:
  struct WorldTriangle {
    std::array<renderer::Vec3f, 3> corners;
    bool double_sided = false;
  };
  static NearestPoint nearest_on(const WorldTriangle& triangle, const Eigen::Vector3d& position);

  std::vector<WorldTriangle> triangles_;
  BoxTree tree_;
};

}  // namespace chiaro::inverse

#pragma once
// How far surfaces are from anywhere, and where the nearest is.

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "inverse/transport/box_tree.h"
#include "inverse/transport/open_edges.h"
#include "renderer/scene/scene.h"

namespace chiaro::inverse {

struct NearestPoint {
  Eigen::Vector3d point;   // on the surface, metres
  Eigen::Vector3d normal;  // unit, on the side of the triangle's winding; zero for a triangle without area
  double distance = 0;     // metres
  bool double_sided = false;
  bool on_open_edge = false;  // the surface of a node ends here; not looked for on the whole scene
};

class NearestSurface {
 public:
  // All drawn surfaces of the scene, or those of the node's instances and of the nodes below it.
  explicit NearestSurface(const renderer::Scene& scene, const std::optional<std::string>& node = {});

  // None where all surfaces are farther than `reach` (metres).
  std::optional<NearestPoint> find(const Eigen::Vector3d& position, double reach) const;

 private:
  struct WorldTriangle {
    WorldCorners corners;
    bool double_sided = false;
    OpenEdges open{};
  };
  static NearestPoint nearest_on(const WorldTriangle& triangle, const Eigen::Vector3d& position);
  void mark_open_edges();

  std::vector<WorldTriangle> triangles_;
  BoxTree tree_;
};

}  // namespace chiaro::inverse

#pragma once
// The surface that receivers span.

#include <Eigen/Core>

#include "inverse/transport/box_tree.h"
#include "inverse/transport/receivers.h"

namespace chiaro::inverse {

// Receivers' triangles and a tree of their boxes; without triangles every receiver is one by itself.
struct ReceiverSurface {
  const Receivers& receivers;
  BoxTree tree;

  renderer::Triangle triangle(std::uint32_t item) const {
    return receivers.triangles.empty() ? renderer::Triangle{item, item, item} : receivers.triangles[item];
  }
};

ReceiverSurface make_receiver_surface(const Receivers& receivers);

struct SurfacePoint {
  double distance = 0;  // metres from where it was looked for
  Eigen::Vector3d position, normal;
  Eigen::Vector3d weights;  // barycentric, of the triangle's corners
};

SurfacePoint closest_on_surface(const ReceiverSurface& surface, std::uint32_t item, const Eigen::Vector3d& point);

}  // namespace chiaro::inverse

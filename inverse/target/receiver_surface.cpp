#include "inverse/target/receiver_surface.h"

#include "inverse/numerics/closest_point.h"
#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {

using Eigen::Vector3d;

ReceiverSurface make_receiver_surface(const Receivers& receivers) {
  ReceiverSurface surface{receivers, {}};
  std::vector<renderer::Box3f> boxes(receivers.triangles.empty() ? receivers.size() : receivers.triangles.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (const std::uint32_t corner : surface.triangle(std::uint32_t(i))) boxes[i].extend(receivers.positions[corner]);
  }
  surface.tree = make_box_tree(boxes);
  return surface;
}

SurfacePoint closest_on_surface(const ReceiverSurface& surface, std::uint32_t item, const Vector3d& point) {
  const renderer::Triangle triangle = surface.triangle(item);
  const Receivers& r = surface.receivers;
  const numerics::TriangleCorners corners{to_eigen(r.positions[triangle[0]]), to_eigen(r.positions[triangle[1]]),
                                          to_eigen(r.positions[triangle[2]])};
  const Vector3d weights = numerics::closest_on_triangle(corners, point);
  SurfacePoint found{0, Vector3d::Zero(), Vector3d::Zero(), weights};
  for (int k = 0; k < 3; ++k) {
    found.position += weights[k] * corners[k];
    found.normal += weights[k] * to_eigen(r.normals[triangle[k]]);
  }
  if (found.normal.norm() > 0) found.normal.normalize();
  found.distance = (found.position - point).norm();
  return found;
}

}  // namespace chiaro::inverse

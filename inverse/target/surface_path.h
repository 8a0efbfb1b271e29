#pragma once
// A stroke's path, laid on the surface.

#include <span>
#include <vector>

#include <Eigen/Core>

#include "inverse/target/receiver_surface.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {

struct SurfacePath {
  struct Piece {
    Eigen::Vector3d from, to;  // the same: a point
  };
  std::vector<Piece> pieces;            // where two of them meet there is a point, too
  std::vector<std::size_t> far_points;  // numbers of points that are farther than the radius from any surface
};

// Points go to the nearest place of a surface that faces them, if it is within `radius` (metres). From one to the next
// the path goes where the surface is cut by the plane of both and of the normals there, the shortest way. Where no such
// way leads there, the points of the straight line between them go to the surface, where it is within the radius.
// control: to be interrupted.
SurfacePath lay_on_surface(const ReceiverSurface& surface, std::span<const Vec3f> points, float radius,
                           const renderer::Control& control = {});

}  // namespace chiaro::inverse

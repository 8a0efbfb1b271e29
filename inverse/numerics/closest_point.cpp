#include "inverse/numerics/closest_point.h"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

namespace chiaro::inverse::numerics {
namespace {

using Eigen::Vector3d;

Vector3d closest_on_edges(const TriangleCorners& corners, const Vector3d& p) {
  Vector3d closest = Vector3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double t = closest_on_segment(corners[i], corners[j], p);
    const double distance = (corners[i] + t * (corners[j] - corners[i]) - p).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    closest = (1 - t) * Vector3d::Unit(i) + t * Vector3d::Unit(j);
  }
  return closest;
}

}  // namespace

double closest_on_segment(const Vector3d& a, const Vector3d& b, const Vector3d& p) {
  const double squared_length = (b - a).squaredNorm();
  return squared_length > 0 ? std::clamp((p - a).dot(b - a) / squared_length, 0.0, 1.0) : 0.0;
}

Vector3d closest_on_triangle(const TriangleCorners& corners, const Vector3d& p) {
  const Vector3d ab = corners[1] - corners[0], ac = corners[2] - corners[0], ap = p - corners[0];
  const Vector3d normal = ab.cross(ac);
  const double v = ap.cross(ac).dot(normal) / normal.squaredNorm();
  const double w = ab.cross(ap).dot(normal) / normal.squaredNorm();
  const bool above = v >= 0 && w >= 0 && v + w <= 1;  // false where the area, and so the normal, is zero
  return above ? Vector3d(1 - v - w, v, w) : closest_on_edges(corners, p);
}

}  // namespace chiaro::inverse::numerics

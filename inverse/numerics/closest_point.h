#pragma once

#include <array>

#include <Eigen/Core>

namespace chiaro::inverse::numerics {

using TriangleCorners = std::array<Eigen::Vector3d, 3>;

// Of the point of segment ab closest to p: its parameter, 0 at a and 1 at b.
double closest_on_segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& p);

// Barycentric coordinates of the point of the triangle (or of the segment or point it has shrunk to) closest to p.
Eigen::Vector3d closest_on_triangle(const TriangleCorners& corners, const Eigen::Vector3d& p);

}  // namespace chiaro::inverse::numerics

#pragma once

#include <optional>

#include "inverse/numerics/closest_point.h"

namespace chiaro::inverse::numerics {

struct ContactSegment {
  Eigen::Vector3d from, to;
};

// Where two triangles meet: they cut through each other, or an edge of one lies on the other within `tolerance`. None
// where they meet in a point, lie in one plane, or have no area.
// Source: T. Möller, A Fast Triangle-Triangle Intersection Test, 1997.
std::optional<ContactSegment> surface_contact(const TriangleCorners& a, const TriangleCorners& b, double tolerance);

}  // namespace chiaro::inverse::numerics

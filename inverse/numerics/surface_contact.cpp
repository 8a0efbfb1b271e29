#include "inverse/numerics/surface_contact.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace chiaro::inverse::numerics {
namespace {

using Eigen::Vector3d;

constexpr double kSamePlane = 0.03;  // sine of the angle between planes ≤ this

Vector3d unit_normal(const TriangleCorners& t) { return (t[1] - t[0]).cross(t[2] - t[0]).normalized(); }

// Where b goes through a's plane; corners within the tolerance of it are put on it.
std::optional<ContactSegment> cut_by_plane(const TriangleCorners& a, const Vector3d& normal, const TriangleCorners& b,
                                           double tolerance) {
  std::array<double, 3> height{};
  for (int k = 0; k < 3; ++k) {
    height[k] = normal.dot(b[k] - a[0]);
    if (std::abs(height[k]) <= tolerance) height[k] = 0;
  }
  std::array<Vector3d, 3> points;
  int count = 0;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (height[k] == 0) points[count++] = b[k] - normal.dot(b[k] - a[0]) * normal;
    if (height[k] * height[next] < 0) {
      points[count++] = b[k] + height[k] / (height[k] - height[next]) * (b[next] - b[k]);
    }
  }
  if (count != 2) return {};
  return ContactSegment{points[0], points[1]};
}

// The part of the segment in a's plane that is in a; along its edges, up to the tolerance beside it.
std::optional<ContactSegment> clip_to(const TriangleCorners& a, const Vector3d& normal, const ContactSegment& segment,
                                      double tolerance) {
  double first = 0, last = 1;
  for (int k = 0; k < 3; ++k) {
    const Vector3d inward = normal.cross(a[(k + 1) % 3] - a[k]).normalized();
    const double from = inward.dot(segment.from - a[k]), to = inward.dot(segment.to - a[k]);
    if (std::min(from, to) >= -tolerance) continue;
    if (std::max(from, to) <= 0) return {};
    (from < to ? first : last) = from < to ? std::max(first, from / (from - to)) : std::min(last, from / (from - to));
  }
  const Vector3d along = segment.to - segment.from;
  if ((last - first) * along.norm() <= 2 * tolerance) return {};
  return ContactSegment{segment.from + first * along, segment.from + last * along};
}

}  // namespace

std::optional<ContactSegment> surface_contact(const TriangleCorners& a, const TriangleCorners& b, double tolerance) {
  const Vector3d normal_a = unit_normal(a), normal_b = unit_normal(b);
  if (!(normal_a.cross(normal_b).norm() > kSamePlane)) return {};
  if (const auto cut = cut_by_plane(a, normal_a, b, tolerance)) {
    if (const auto contact = clip_to(a, normal_a, *cut, tolerance)) return contact;
  }
  if (const auto cut = cut_by_plane(b, normal_b, a, tolerance)) return clip_to(b, normal_b, *cut, tolerance);
  return {};
}

}  // namespace chiaro::inverse::numerics

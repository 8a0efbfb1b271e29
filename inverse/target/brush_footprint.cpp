#include "inverse/target/brush_footprint.h"

#include <algorithm>
#include <array>
#include <limits>

#include "inverse/numerics/closest_point.h"

namespace chiaro::inverse {
namespace {

using Eigen::Vector3d;
using renderer::Box3f;
using renderer::Triangle;

constexpr float kFacingCosine = 0.2F;   // between normal and side; `facing` is 1 from here on, and 0 at a cosine of 0
constexpr float kLeastFacing = 1e-3F;   // touched: facing > this
constexpr double kSameDistance = 1e-4;  // on both surfaces: distances differ by ≤ this × radius
constexpr double kFarAway = std::numeric_limits<double>::infinity();

// Of double precision, so that no path of finite floats overflows.
Vector3d wide(Vec3f v) { return {v.x, v.y, v.z}; }

// Without triangles every receiver stands for itself.
Triangle surface_triangle(const Receivers& receivers, std::uint32_t item) {
  return receivers.triangles.empty() ? Triangle{item, item, item} : receivers.triangles[item];
}

struct SurfacePoint {
  double distance = kFarAway;
  Vec3f normal;
};

SurfacePoint closest_on_surface(const Receivers& receivers, std::uint32_t item, Vec3f point) {
  const Triangle triangle = surface_triangle(receivers, item);
  const numerics::TriangleCorners corners{wide(receivers.positions[triangle[0]]),
                                          wide(receivers.positions[triangle[1]]),
                                          wide(receivers.positions[triangle[2]])};
  const Vector3d weights = numerics::closest_on_triangle(corners, wide(point));
  Vector3d position = Vector3d::Zero();
  Vec3f normal;
  for (int i = 0; i < 3; ++i) {
    position += weights[i] * corners[i];
    normal += float(weights[i]) * receivers.normals[triangle[i]];
  }
  const float length = renderer::length(normal);
  return {(position - wide(point)).norm(), length > 0 ? normal / length : Vec3f{}};
}

using Sides = std::vector<Vec3f>;

// Normals of the surface that `point` lies on: of all triangles that are as near as the nearest.
Sides sides_at(const Receivers& receivers, const BoxTree& surface, Vec3f point, float radius) {
  double nearest = kFarAway;
  visit_near(surface, point, nearest, [&](std::uint32_t item) {
    return nearest = std::min(nearest, closest_on_surface(receivers, item, point).distance);
  });
  const double reach = nearest + kSameDistance * radius;
  Sides sides;
  visit_near(surface, point, reach, [&](std::uint32_t item) {
    const SurfacePoint found = closest_on_surface(receivers, item, point);
    if (found.distance <= reach) sides.push_back(found.normal);
    return reach;
  });
  return sides;
}

// A step at some cosine would show the receivers' triangles in the picture.
float facing(Vec3f normal, const Sides& sides) {
  float cosine = 0;
  for (const Vec3f side : sides) cosine = std::max(cosine, dot(normal, side));
  const float t = std::min(cosine / kFacingCosine, 1.0F);
  return t * t * (3 - 2 * t);
}

struct Path {
  const std::vector<Vec3f>& points;
  BoxTree segments;  // segment i joins points i and i + 1; one point is a segment of no length

  std::size_t end_of(std::size_t segment) const { return std::min(segment + 1, points.size() - 1); }
};

Path make_path(const std::vector<Vec3f>& points) {
  Path path{points, {}};
  std::vector<Box3f> boxes(std::max<std::size_t>(points.size(), 2) - 1);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    boxes[i].extend(points[i]);
    boxes[i].extend(points[path.end_of(i)]);
  }
  path.segments = make_box_tree(boxes);
  return path;
}

struct PathPoint {
  double distance = kFarAway;
  std::size_t segment = 0;
  bool nearer_end = false;  // to the segment's end than to its start
};

// The point of the path closest to `point`, of the first segment where several are as close; far away: not within
// reach.
PathPoint closest_on_path(const Path& path, Vec3f point, double reach) {
  PathPoint closest;
  visit_near(path.segments, point, reach, [&](std::uint32_t segment) {
    const Vector3d a = wide(path.points[segment]), b = wide(path.points[path.end_of(segment)]);
    const double t = numerics::closest_on_segment(a, b, wide(point));
    const double distance = (a + t * (b - a) - wide(point)).norm();
    if (distance < closest.distance || (distance == closest.distance && segment < closest.segment)) {
      closest = {distance, segment, t > 0.5};
    }
    return std::min(reach, closest.distance);
  });
  return closest;
}

}  // namespace

BoxTree make_surface_tree(const Receivers& receivers) {
  std::vector<Box3f> boxes(receivers.triangles.empty() ? receivers.size() : receivers.triangles.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (const std::uint32_t corner : surface_triangle(receivers, std::uint32_t(i))) {
      boxes[i].extend(receivers.positions[corner]);
    }
  }
  return make_box_tree(boxes);
}

std::vector<TouchedReceiver> brush_footprint(const Receivers& receivers, const BoxTree& surface, const Stroke& stroke) {
  const Path path = make_path(stroke.path);
  std::vector<Sides> sides;
  if (stroke.facing) {
    for (const Vec3f point : stroke.path) sides.push_back(sides_at(receivers, surface, point, stroke.radius));
  }
  std::vector<TouchedReceiver> touched;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const PathPoint closest = closest_on_path(path, receivers.positions[i], stroke.radius);
    if (!(closest.distance <= stroke.radius)) continue;
    const std::size_t end = closest.nearer_end ? path.end_of(closest.segment) : closest.segment;
    const float faced = stroke.facing ? facing(receivers.normals[i], sides[end]) : 1;
    if (faced > kLeastFacing) touched.push_back({i, float(closest.distance), faced});
  }
  return touched;
}

}  // namespace chiaro::inverse

#include "inverse/target/receiver_lookup.h"

#include <limits>

#include "inverse/numerics/closest_point.h"
#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

using renderer::Box3f;
using renderer::Triangle;

constexpr float kSameSide = 0.5F;       // cosine of the normals, or more
constexpr double kOnTriangle = 1e-3;    // metres per metre of the receivers' diagonal, or less
constexpr double kNearReceiver = 0.05;  // the same, where there are no triangles
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

Triangle triangle_of(const Receivers& receivers, std::uint32_t item) {
  return receivers.triangles.empty() ? Triangle{item, item, item} : receivers.triangles[item];
}

std::vector<Box3f> boxes_of(const Receivers& receivers) {
  std::vector<Box3f> boxes(receivers.triangles.empty() ? receivers.size() : receivers.triangles.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (const auto corner : triangle_of(receivers, std::uint32_t(i))) boxes[i].extend(receivers.positions[corner]);
  }
  return boxes;
}

double diagonal_of(const BoxTree& surface) { return surface.nodes.empty() ? 0 : surface.nodes[0].box.diagonal(); }

// Of the triangle, on the side of its corners' normals.
Vec3f side_of(const Receivers& receivers, const Triangle& t) {
  const Vec3f smooth = receivers.normals[t[0]] + receivers.normals[t[1]] + receivers.normals[t[2]];
  const Vec3f& a = receivers.positions[t[0]];
  const Vec3f flat = cross(receivers.positions[t[1]] - a, receivers.positions[t[2]] - a);
  const Vec3f side = length(flat) > 0 ? (dot(flat, smooth) < 0 ? -flat : flat) : smooth;
  return length(side) > 0 ? normalize(side) : Vec3f{};
}

}  // namespace

ReceiverLookup::ReceiverLookup(const Receivers& receivers)
    : receivers_(receivers),
      surface_(make_box_tree(boxes_of(receivers))),
      reach_((receivers.triangles.empty() ? kNearReceiver : kOnTriangle) * diagonal_of(surface_)) {}

std::optional<ReceiverWeights> ReceiverLookup::find(Vec3f position, Vec3f normal) const {
  const Eigen::Vector3d point = to_eigen(position);
  double reach = reach_;
  std::uint32_t nearest = kNone;
  Eigen::Vector3d nearest_weights;
  visit_near(surface_, position, reach, [&](std::uint32_t item) {
    const Triangle t = triangle_of(receivers_, item);
    const numerics::TriangleCorners corners{to_eigen(receivers_.positions[t[0]]), to_eigen(receivers_.positions[t[1]]),
                                            to_eigen(receivers_.positions[t[2]])};
    const Eigen::Vector3d weights = numerics::closest_on_triangle(corners, point);
    const Eigen::Vector3d closest = weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
    const double distance = (closest - point).norm();
    const bool nearer = distance < reach || (distance == reach && item < nearest);
    if (nearer && dot(side_of(receivers_, t), normal) >= kSameSide) {
      reach = distance;
      nearest = item;
      nearest_weights = weights;
    }
    return reach;
  });
  if (nearest == kNone) return std::nullopt;
  ReceiverWeights found{triangle_of(receivers_, nearest), {}};
  for (int k = 0; k < 3; ++k) found.weights[k] = float(nearest_weights[k]);
  return found;
}

}  // namespace chiaro::inverse

#include "inverse/target/receiver_lookup.h"

#include <limits>

#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

using renderer::Triangle;

constexpr float kSameSide = 0.5F;       // cosine of the normals, or more
constexpr double kOnTriangle = 1e-3;    // metres per metre of the receivers' diagonal, or less
constexpr double kNearReceiver = 0.05;  // the same, where there are no triangles
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

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
    : surface_(make_receiver_surface(receivers)),
      reach_((receivers.triangles.empty() ? kNearReceiver : kOnTriangle) * diagonal_of(surface_.tree)) {}

std::optional<ReceiverWeights> ReceiverLookup::find(Vec3f position, Vec3f normal) const {
  const Eigen::Vector3d point = to_eigen(position);
  double reach = reach_;
  std::uint32_t nearest = kNone;
  Eigen::Vector3d nearest_weights;
  visit_near(surface_.tree, position, reach, [&](std::uint32_t item) {
    const SurfacePoint found = closest_on_surface(surface_, item, point);
    const bool nearer = found.distance < reach || (found.distance == reach && item < nearest);
    if (nearer && dot(side_of(surface_.receivers, surface_.triangle(item)), normal) >= kSameSide) {
      reach = found.distance;
      nearest = item;
      nearest_weights = found.weights;
    }
    return reach;
  });
  if (nearest == kNone) return std::nullopt;
  ReceiverWeights found{surface_.triangle(nearest), {}};
  for (int k = 0; k < 3; ++k) found.weights[k] = float(nearest_weights[k]);
  return found;
}

}  // namespace chiaro::inverse

// Projections onto one rule after the other until all hold (alternating projections): Bauschke, Borwein, On projection
// algorithms for solving convex feasibility problems, 1996. The rules are not convex, so a place is checked before it
// is given out.

#include "inverse/transport/allowed_places.h"

#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Geometry>

#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/world_limits.h"

namespace chiaro::inverse {
namespace {

using Eigen::Vector3d;
using renderer::Box3f;
using renderer::Vec3f;

constexpr int kRounds = 40;
constexpr double kFarther = 1e-5;           // in parts of a distance: what is pushed away ends clearly beyond it
constexpr double kHanging = 1e-3;           // in parts of the clearance, or …
constexpr double kHangingAt = 1e-4;         // … metres, or …
constexpr double kHangingPart = 1e-5;       // … of the scene's diagonal, where that is less: it is kept
constexpr double kDefaultClearance = 0.01;  // of the scene's diagonal
constexpr double kInFront = 0.5;            // cosine between a surface's normal and the way to a light, at least
constexpr double kAnywhere = std::numeric_limits<double>::infinity();

Vector3d clamped(const Vector3d& position, const Box3f& box) {
  return position.cwiseMax(to_eigen(box.min)).cwiseMin(to_eigen(box.max));
}

Box3f intersection(const Box3f& a, const Box3f& b) { return {max(a.min, b.min), min(a.max, b.max)}; }

Box3f grown(const Box3f& box, double by) {
  const Vec3f room{float(by), float(by), float(by)};
  return {box.min - room, box.max + room};
}

// What is pushed so far from something at this position stays as far once rounded to floats.
double farther(double distance, const Vector3d& position) {
  return distance * (1 + kFarther) + double(std::numeric_limits<float>::epsilon()) * position.cwiseAbs().maxCoeff();
}

// Unit; any where there is none.
Vector3d direction(const Vector3d& from, const Vector3d& to, const Vector3d& otherwise) {
  const double length = (to - from).norm();
  return length > 0 ? Vector3d((to - from) / length) : otherwise;
}

double clearance_of(const Mount& mount, const renderer::Scene& scene) {
  if (mount.clearance && !(*mount.clearance <= double(renderer::kWorldLimit))) {
    refuse(scene, mount.asked_in, fmt::format("a clearance of {:g} m", *mount.clearance),
           fmt::format("at most {:g} m", renderer::kWorldLimit));
  }
  return mount.clearance ? *mount.clearance : kDefaultClearance * double(renderer::bounds(scene).diagonal());
}

double tolerance_of(double clearance, const renderer::Scene& scene) {
  const double rounding = std::min(kHangingAt, kHangingPart * double(renderer::bounds(scene).diagonal()));
  return std::max(kHanging * clearance, rounding);
}

[[noreturn]] void too_near(const Mount& mount, const renderer::Scene& scene, double surface_distance) {
  refuse(scene, mount.asked_in,
         fmt::format("no light possible: lights are to hang {} m from \"{}\", and no nearer than {} m to any surface",
                     clearance_of(mount, scene), mount.node, surface_distance),
         "a distance to surfaces no larger than the clearance");
}

void check_node(const Mount& mount, const renderer::Scene& scene) {
  if (!renderer::bounds_of_node(scene, mount.node).empty()) return;
  refuse(scene, mount.asked_in,
         fmt::format("no node with a mesh, or above one, to hang lights on is named \"{}\"", mount.node),
         "a node's name");
}

}  // namespace

std::string where_lights_may_stand(const PlaceRules& rules) {
  std::vector<std::string> nodes;
  for (const Mount& mount : rules.mounts) nodes.push_back('"' + mount.node + '"');
  const std::string hanging = fmt::format("where lights hang on {}", fmt::join(nodes, ", "));
  if (nodes.empty()) return "in the region";
  return rules.boxes.empty() ? hanging : "in the region or " + hanging;
}

std::string so_far_from_surfaces(const PlaceRules& rules) {
  return rules.surface_distance > 0 ? fmt::format(" {} m from all surfaces", rules.surface_distance) : "";
}

NoUsableGrid no_place(const renderer::Scene& scene, const PlaceRules& rules) {
  return NoUsableGrid({scene.path, "solve",
                       fmt::format("no light possible: nowhere {} is a place{}", where_lights_may_stand(rules),
                                   so_far_from_surfaces(rules)),
                       "a smaller distance to surfaces, or a larger region"});
}

LightGridOptions around_places(LightGridOptions grid, const renderer::Scene& scene, const PlaceRules& rules) {
  grid.parts = rules.boxes;
  if (!rules.mounts.empty()) grid.region = renderer::bounds(scene);
  for (const Mount& mount : rules.mounts) {
    check_node(mount, scene);
    grid.parts.push_back(grown(renderer::bounds_of_node(scene, mount.node), clearance_of(mount, scene)));
  }
  for (const Box3f& part : grid.parts) {
    if (!grid.region) grid.region.emplace();
    grid.region->extend(part.min);
    grid.region->extend(part.max);
  }
  return grid;
}

AllowedPlaces::AllowedPlaces(const Box3f& region) : boxes_{region} {}

AllowedPlaces::AllowedPlaces(const renderer::Scene& scene, const Box3f& region, const PlaceRules& rules,
                             std::vector<Vector3d> lights_that_stay)
    : rules_(rules), stay_(std::move(lights_that_stay)) {
  for (const Box3f& box : rules.boxes) {
    if (const Box3f inside = intersection(box, region); !inside.empty()) boxes_.push_back(inside);
  }
  for (const Mount& mount : rules.mounts) {
    check_node(mount, scene);
    const double clearance = clearance_of(mount, scene);
    if (clearance < rules.surface_distance) continue;
    mounts_.push_back(std::make_shared<MountedSurface>(
        MountedSurface{NearestSurface(scene, mount.node), clearance, tolerance_of(clearance, scene)}));
  }
  const bool anywhere = rules.boxes.empty() && rules.mounts.empty();
  if (anywhere) boxes_.push_back(region);
  if (boxes_.empty() && mounts_.empty()) {
    if (!rules.mounts.empty()) too_near(rules.mounts.front(), scene, rules.surface_distance);
    throw NoUsableGrid({scene.path, "region", "no light possible: lies outside the grid of lights",
                        "a region that the transport was baked for"});
  }
  if (rules.surface_distance > 0) surfaces_ = std::make_shared<NearestSurface>(scene);
}

bool AllowedPlaces::clear_of_surfaces(const Vector3d& position) const {
  return !surfaces_ || !surfaces_->find(position, std::nextafter(rules_.surface_distance, 0));
}

// One step, away from the nearest.
Vector3d AllowedPlaces::away_from_surfaces(const Vector3d& position) const {
  const double distance = farther(rules_.surface_distance, position);
  const auto near = surfaces_ ? surfaces_->find(position, distance) : std::nullopt;
  if (!near) return position;
  return near->point + distance * direction(near->point, position, near->normal);
}

// The direction to it leads away from the surface, and not past its end.
bool AllowedPlaces::is_in_front(const MountedSurface& mount, const NearestPoint& near, const Vector3d& position) {
  const Vector3d way = position - near.point;
  const double along = way.dot(near.normal);
  const double beside = (way - along * near.normal).norm();
  if (near.on_open_edge && beside > mount.tolerance) return false;
  return (near.double_sided ? std::abs(along) : along) >= kInFront * near.distance;
}

Vector3d AllowedPlaces::in_front_of(const MountedSurface& mount, const Vector3d& position) const {
  const NearestPoint near = *mount.surface.find(position, kAnywhere);
  const bool behind = near.double_sided && (position - near.point).dot(near.normal) < 0;
  const Vector3d normal = behind ? Vector3d(-near.normal) : near.normal;
  const Vector3d outwards = is_in_front(mount, near, position) ? direction(near.point, position, normal) : normal;
  // Rounded to floats, a place at the very clearance may be nearer than surfaces allow.
  const double distance = std::max(mount.clearance, farther(rules_.surface_distance, near.point));
  return near.point + distance * outwards;
}

bool AllowedPlaces::hangs_on(const MountedSurface& mount, const Vector3d& position) const {
  const NearestPoint near = *mount.surface.find(position, kAnywhere);
  return is_in_front(mount, near, position) && std::abs(near.distance - mount.clearance) <= mount.tolerance;
}

bool AllowedPlaces::contains(const Vector3d& position) const {
  const Vector3d given = rounded_to_float(position);
  const bool in_box =
      std::any_of(boxes_.begin(), boxes_.end(), [&](const Box3f& box) { return box.contains(to_vec3f(given)); });
  const bool mounted =
      std::any_of(mounts_.begin(), mounts_.end(), [&](const auto& mount) { return hangs_on(*mount, given); });
  return (in_box || mounted) && clear_of_surfaces(given);
}

std::optional<Vector3d> AllowedPlaces::nearest(const Vector3d& position) const {
  std::optional<Vector3d> best;
  const auto settle_by = [&](const auto& project) {
    Vector3d p = project(position);
    for (int round = 0; round < kRounds && !contains(p); ++round) p = project(away_from_surfaces(p));
    p = surfaces_ || !mounts_.empty() ? rounded_to_float(p) : p;
    const bool nearer = !best || (p - position).norm() < (*best - position).norm();
    if (nearer && contains(p)) best = p;
  };
  for (const Box3f& box : boxes_) settle_by([&](const Vector3d& p) { return clamped(p, box); });
  for (const auto& mount : mounts_) settle_by([&](const Vector3d& p) { return in_front_of(*mount, p); });
  return best;
}

bool AllowedPlaces::has_room(const Vector3d& further, std::span<const Vector3d> positions) const {
  if (!(rules_.light_distance > 0)) return true;
  const Vector3d here = rounded_to_float(further);
  const auto near = [&](const Vector3d& p) { return (rounded_to_float(p) - here).norm() < rules_.light_distance; };
  return std::none_of(stay_.begin(), stay_.end(), near) && std::none_of(positions.begin(), positions.end(), near);
}

bool AllowedPlaces::far_apart(const std::vector<Vector3d>& positions) const {
  for (std::size_t j = 0; j < positions.size(); ++j) {
    if (!has_room(positions[j], std::span(positions).first(j))) return false;
  }
  return true;
}

// One step for each pair that is too close.
void AllowedPlaces::push_apart(std::vector<Vector3d>& positions) const {
  const Vector3d otherwise = Vector3d(1, 2, 3).normalized();
  for (std::size_t j = 0; j < positions.size(); ++j) {
    for (const Vector3d& fixed : stay_) {
      const double lack = farther(rules_.light_distance, positions[j]) - (positions[j] - fixed).norm();
      if (lack > 0) positions[j] += lack * direction(fixed, positions[j], otherwise);
    }
    for (std::size_t k = 0; k < j; ++k) {
      const double lack = farther(rules_.light_distance, positions[j]) - (positions[j] - positions[k]).norm();
      if (lack <= 0) continue;
      const Vector3d apart = direction(positions[k], positions[j], otherwise);
      positions[j] += lack / 2 * apart;
      positions[k] -= lack / 2 * apart;
    }
  }
}

bool AllowedPlaces::settle(std::vector<Vector3d>& positions) const {
  const auto place = [&] {
    for (Vector3d& position : positions) {
      const auto found = nearest(position);
      if (!found) return false;
      position = *found;
    }
    return true;
  };
  if (!place()) return false;
  for (int round = 0; round < kRounds && !far_apart(positions); ++round) {
    push_apart(positions);
    if (!place()) return false;
  }
  return far_apart(positions);
}

}  // namespace chiaro::inverse

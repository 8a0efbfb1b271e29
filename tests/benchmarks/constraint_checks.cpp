#include "tests/benchmarks/constraint_checks.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "inverse/transport/light_grid.h"
#include "inverse/transport/nearest_surface.h"
#include "renderer/core/blackbody.h"
#include "tests/support/distance_to_surfaces.h"

namespace chiaro::benchmarks {
namespace {

using Eigen::Vector3d;
using inverse::LightConstraints;
using inverse::Mount;
using inverse::to_eigen;
using renderer::Box3f;
using renderer::Vec3f;

constexpr double kRounding = 1e-6;         // of distances, relative
constexpr double kSameColor = 1e-4;        // relative
constexpr double kBlackBody = 1e-3;        // relative
constexpr double kHanging = 1.001e-3;      // of the clearance, or …
constexpr double kHangingAt = 1.001e-4;    // … metres
constexpr double kInFront = 0.4999;        // cosine
constexpr double kAtEdge = 1e-6;           // metres
constexpr double kDefaultClearance = .01;  // of the scene's diagonal
constexpr double kOnSurface = 1e-4;        // metres, or less: no light stands there
constexpr std::uint32_t kTries = 3000;     // of a random search

std::optional<Vector3d> position_of(const renderer::Light& light) {
  if (const auto* point = std::get_if<renderer::PointLight>(&light)) return to_eigen(point->position);
  if (const auto* spot = std::get_if<renderer::SpotLight>(&light)) return to_eigen(spot->position);
  return std::nullopt;
}

Vec3f intensity_of(const renderer::Light& light) {
  if (const auto* point = std::get_if<renderer::PointLight>(&light)) return point->intensity;
  if (const auto* spot = std::get_if<renderer::SpotLight>(&light)) return spot->intensity;
  return std::get<renderer::DirectionalLight>(light).illuminance;
}

std::vector<Vector3d> positions_of(const renderer::Lights& lights) {
  std::vector<Vector3d> positions;
  for (const renderer::Light& light : lights) {
    if (const auto position = position_of(light)) positions.push_back(*position);
  }
  return positions;
}

// visit(corners, material)
template <class Visit>
void each_triangle(const renderer::Scene& scene, const std::string& node, const Visit& visit) {
  for (const renderer::Instance& instance : scene.instances) {
    if (!node.empty() && instance.name != node) continue;
    const renderer::Mesh& mesh = scene.meshes[instance.mesh];
    const bool mirrored = determinant3(instance.world_from_object) < 0;
    for (const renderer::Triangle& triangle : mesh.triangles) {
      std::array<Vector3d, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = to_eigen(transform_point(instance.world_from_object, mesh.positions[triangle[k]]));
      }
      if (mirrored) std::swap(corners[1], corners[2]);
      visit(corners, scene.materials[mesh.material]);
    }
  }
}

Box3f bounds_of(const renderer::Scene& scene, const std::string& node) {
  Box3f bounds;
  each_triangle(scene, node, [&](const auto& corners, const auto&) {
    for (const Vector3d& corner : corners) bounds.extend(inverse::to_vec3f(corner));
  });
  return bounds;
}

double clearance_of(const renderer::Scene& scene, const Mount& mount) {
  return mount.clearance.value_or(kDefaultClearance * double(bounds_of(scene, "").diagonal()));
}

using Corners = std::array<Vector3d, 3>;

double distance_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const double along = std::clamp((p - a).dot(b - a) / std::max((b - a).squaredNorm(), 1e-300), 0.0, 1.0);
  return (a + along * (b - a) - p).norm();
}

bool has_corner(const Corners& corners, const Vector3d& corner) {
  return std::find(corners.begin(), corners.end(), corner) != corners.end();
}

// The surface ends there: at an edge of this triangle alone.
bool is_at_an_end(const renderer::Scene& scene, const std::string& node, const Corners& corners, const Vector3d& at) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d &a = corners[k], &b = corners[(k + 1) % 3];
    if (distance_to_segment(at, a, b) > kAtEdge) continue;
    int triangles = 0;
    each_triangle(scene, node, [&](const Corners& other, const auto&) {
      triangles += has_corner(other, a) && has_corner(other, b) ? 1 : 0;
    });
    if (triangles == 1) return true;
  }
  return false;
}

// As far from the node as wanted, and not beside or behind all of its nearest triangles, nor past where they end.
bool hangs_on(const renderer::Scene& scene, const Mount& mount, const Vector3d& position) {
  const double clearance = clearance_of(scene, mount), least = test::distance_to_surfaces(scene, position, mount.node);
  const double tolerance = std::max(kHanging * clearance, kHangingAt);
  if (std::abs(least - clearance) > tolerance) return false;
  bool in_front = false;
  each_triangle(scene, mount.node, [&](const Corners& corners, const renderer::Material& material) {
    const Vector3d nearest = test::nearest_point_of(corners, position), way = position - nearest;
    if (way.norm() > least + 1e-6) return;
    const Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    const double along = material.double_sided ? std::abs(way.dot(normal)) : way.dot(normal);
    const double beside = (way - way.dot(normal) * normal).norm();
    const bool past_the_end = beside > tolerance && is_at_an_end(scene, mount.node, corners, nearest);
    in_front = in_front || (!past_the_end && along >= kInFront * way.norm() - 1e-6);
  });
  return in_front;
}

bool is_in_a_region(const renderer::Scene& scene, const LightConstraints& c, const Vector3d& position) {
  if (c.regions.empty() && c.mounts.empty()) return true;
  const auto in_box = [&](const inverse::Region& region) {
    return inverse::parse_region(scene, region).contains(inverse::to_vec3f(position));
  };
  const auto on_node = [&](const Mount& mount) { return hangs_on(scene, mount, position); };
  return std::any_of(c.regions.begin(), c.regions.end(), in_box) ||
         std::any_of(c.mounts.begin(), c.mounts.end(), on_node);
}

void check_place(const renderer::Scene& scene, const LightConstraints& c, const Vector3d& position,
                 std::vector<Violation>& found) {
  if (!is_in_a_region(scene, c, position)) {
    found.push_back({"region", fmt::format("({}, {}, {}) is in none", position.x(), position.y(), position.z())});
  }
  if (!c.surface_distance) return;
  const double distance = test::distance_to_surfaces(scene, position);
  if (distance < *c.surface_distance * (1 - kRounding)) {
    found.push_back({"surface distance", fmt::format("{} m at ({}, {}, {}), wanted {}", distance, position.x(),
                                                     position.y(), position.z(), *c.surface_distance)});
  }
}

// No two of them, nor any and one that stays.
bool far_apart(const std::vector<Vector3d>& positions, const std::vector<Vector3d>& stay, double distance) {
  for (std::size_t j = 0; j < positions.size(); ++j) {
    const auto near = [&](const Vector3d& p) { return (p - positions[j]).norm() < distance * (1 - kRounding); };
    if (std::any_of(positions.begin() + std::ptrdiff_t(j) + 1, positions.end(), near)) return false;
    if (std::any_of(stay.begin(), stay.end(), near)) return false;
  }
  return true;
}

double distance_to_black_bodies(const Vec3f& color, const std::array<double, 2>& kelvin) {
  constexpr int kSteps = 4000;
  const double low = 1e6 / kelvin[1], high = 1e6 / kelvin[0];
  float least = renderer::kInfinity;
  for (int k = 0; k <= kSteps; ++k) {
    least = std::min(least, length(color - renderer::blackbody_color(1e6 / (low + (high - low) * k / kSteps))));
  }
  return double(least);
}

void check_colors(const LightConstraints& c, const renderer::Lights& lights, std::vector<Violation>& found) {
  std::optional<Vec3f> first;
  for (const renderer::Light& light : lights) {
    const Vec3f intensity = intensity_of(light);
    const float most = max_component(intensity);
    if (!(min_component(intensity) >= 0) || !std::isfinite(most)) found.push_back({"intensity", "not a number ≥ 0"});
    if (c.max_intensity && double(most) > *c.max_intensity) {
      found.push_back({"max intensity", fmt::format("{}, wanted {}", most, *c.max_intensity)});
    }
    if (!(most > 0)) continue;
    const Vec3f color = intensity / most;
    if (!first) first = color;
    if (c.one_color && double(length(color - *first)) > kSameColor) {
      found.push_back({"one color", fmt::format("differ by {}", length(color - *first))});
    }
    const double off = c.kelvin ? distance_to_black_bodies(color, *c.kelvin) : 0;
    if (off > kBlackBody) found.push_back({"kelvin", fmt::format("off by {}", off)});
  }
}

bool stands_still(const renderer::Light& before, const renderer::Light& after) {
  if (before.index() != after.index() || position_of(before) != position_of(after)) return false;
  if (const auto* spot = std::get_if<renderer::SpotLight>(&before)) {
    const auto& other = std::get<renderer::SpotLight>(after);
    return spot->direction == other.direction && spot->inner_cone_angle == other.inner_cone_angle &&
           spot->outer_cone_angle == other.outer_cone_angle;
  }
  const auto* sun = std::get_if<renderer::DirectionalLight>(&before);
  return sun == nullptr || sun->direction == std::get<renderer::DirectionalLight>(after).direction;
}

void check_count(const LightConstraints& c, std::size_t count, std::vector<Violation>& found) {
  if (count == 0) found.push_back({"no light", "none found"});
  if (c.lights && int(count) != *c.lights) {
    found.push_back({"light count", fmt::format("{}, wanted {}", count, *c.lights)});
  }
  if (c.max_lights && int(count) > *c.max_lights) {
    found.push_back({"max lights", fmt::format("{}, wanted {}", count, *c.max_lights)});
  }
}

// In a box, or in front of a node.
std::vector<Vector3d> random_places(const renderer::RayTracer& tracer, const LightConstraints& c, std::uint64_t seed) {
  const renderer::Scene& scene = tracer.scene();
  std::vector<Box3f> boxes;
  for (const inverse::Region& region : c.regions) boxes.push_back(inverse::parse_region(scene, region));
  if (c.regions.empty() && c.mounts.empty()) boxes.push_back(tracer.bounds());
  std::vector<std::vector<std::array<Vector3d, 3>>> triangles(c.mounts.size());
  for (std::size_t m = 0; m < c.mounts.size(); ++m) {
    each_triangle(scene, c.mounts[m].node, [&](const auto& t, const auto&) { triangles[m].push_back(t); });
  }
  std::vector<Vector3d> places;
  for (std::uint32_t k = 0; k < kTries; ++k) {
    renderer::Sampler sampler(seed, 2, k);
    const std::size_t source = std::size_t(sampler.next_1d() * float(boxes.size() + c.mounts.size()));
    if (source < boxes.size()) {
      places.push_back(to_eigen(inverse::random_position(boxes[source], sampler)));
      continue;
    }
    const auto& of = triangles[source - boxes.size()];
    const auto& t = of[std::size_t(sampler.next_1d() * float(of.size()))];
    const renderer::Vec2f u = sampler.next_2d();
    const Vector3d on = t[0] + std::sqrt(double(u.x)) * (double(1 - u.y) * (t[1] - t[0]) + double(u.y) * (t[2] - t[0]));
    const double clearance = clearance_of(scene, c.mounts[source - boxes.size()]);
    places.push_back(on + clearance * (t[1] - t[0]).cross(t[2] - t[0]).normalized());
  }
  for (Vector3d& place : places) place = to_eigen(inverse::to_vec3f(place));
  return places;
}

}  // namespace

std::vector<Violation> violations(const renderer::Scene& scene, const LightConstraints& c,
                                  const renderer::Lights& scene_lights,
                                  const std::vector<inverse::FoundLight>& result) {
  std::vector<Violation> found;
  renderer::Lights lights;
  for (const inverse::FoundLight& light : result) lights.push_back(light.light);
  check_count(c, lights.size(), found);
  check_colors(c, lights, found);
  for (const Vector3d& position : positions_of(lights)) check_place(scene, c, position, found);
  const auto stay = c.keep_lights ? positions_of(scene_lights) : std::vector<Vector3d>{};
  if (c.light_distance && !far_apart(positions_of(lights), stay, *c.light_distance)) {
    found.push_back({"light distance", fmt::format("nearer than {}", *c.light_distance)});
  }
  if (!c.keep_positions) return found;
  if (!std::equal(lights.begin(), lights.end(), scene_lights.begin(), scene_lights.end(),
                  [](const auto& a, const auto& b) { return stands_still(b, a); })) {
    found.push_back({"positions", "a light moved"});
  }
  return found;
}

bool places_exist(const renderer::RayTracer& tracer, const LightConstraints& c, const renderer::Lights& scene_lights,
                  std::uint64_t seed) {
  const renderer::Scene& scene = tracer.scene();
  const inverse::FreeSpace free_space(tracer);
  const inverse::NearestSurface surfaces(scene);
  const auto stay = c.keep_lights ? positions_of(scene_lights) : std::vector<Vector3d>{};
  std::vector<Vector3d> chosen;
  for (const Vector3d& place : random_places(tracer, c, seed)) {
    if (chosen.size() == std::size_t(c.lights.value_or(1))) break;
    if (surfaces.find(place, std::max(kOnSurface, c.surface_distance.value_or(0)))) continue;
    if (!free_space.contains(inverse::to_vec3f(place), 0)) continue;
    chosen.push_back(place);
    std::vector<Violation> none;
    const bool apart = !c.light_distance || far_apart(chosen, stay, *c.light_distance);
    if (apart) check_place(scene, c, place, none);
    if (!apart || !none.empty()) chosen.pop_back();
  }
  return chosen.size() == std::size_t(c.lights.value_or(1));
}

}  // namespace chiaro::benchmarks

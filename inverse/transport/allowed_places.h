#pragma once
// Where a user lets lights stand.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "inverse/transport/light_grid.h"
#include "inverse/transport/nearest_surface.h"
#include "renderer/core/error.h"

namespace chiaro::inverse {

// Of a region's diagonal: a light so near its border would rather stand outside.
inline constexpr double kAtBorder = 0.005;

// Lights hang in front of this node's surfaces, and not beside their edges.
struct Mount {
  std::string node;
  std::optional<double> clearance{};  // metres, from its surfaces; absent: a hundredth of the scene's diagonal
  AskedIn asked_in{"", "option --on-surface"};
};

struct PlaceRules {
  std::vector<renderer::Box3f> boxes{};  // lights stand in one of them, or hang on one …
  std::vector<Mount> mounts{};           // … of these; neither given: anywhere
  double surface_distance = 0;           // metres, from every surface, at least
  double light_distance = 0;             // metres, between any two lights, at least
};

// For messages: "in the region", "where lights hang on …"; and " 0.3 m from all surfaces", or nothing.
std::string where_lights_may_stand(const PlaceRules& rules);
std::string so_far_from_surfaces(const PlaceRules& rules);
// What a solve ends with where no light of its grid is near an allowed place.
NoUsableGrid no_place(const renderer::Scene& scene, const PlaceRules& rules);

// A grid of lights where the rules allow any, and no farther than a cell from there: over the boxes, and where lights
// hang on surfaces over the whole scene. Error for a node that is not there.
LightGridOptions around_places(LightGridOptions grid, const renderer::Scene& scene, const PlaceRules& rules);

class AllowedPlaces {
 public:
  // Anywhere in the region.
  explicit AllowedPlaces(const renderer::Box3f& region);
  // Boxes count as far as they lie in the region, and mounts that are not nearer to surfaces than lights may be. Error
  // for a node that is not there or has no surface, and where neither boxes nor mounts are left. Lights that stay are
  // kept away from by the rules' distance, too.
  AllowedPlaces(const renderer::Scene& scene, const renderer::Box3f& region, const PlaceRules& rules,
                std::vector<Eigen::Vector3d> lights_that_stay = {});

  // The nearest place of one light, as far as it is found: an allowed one in any case.
  std::optional<Eigen::Vector3d> nearest(const Eigen::Vector3d& position) const;
  // As it is given out, in floats.
  bool contains(const Eigen::Vector3d& position) const;
  // Beside lights that stand there, and those that stay.
  bool has_room(const Eigen::Vector3d& further, std::span<const Eigen::Vector3d> positions) const;
  // No two lights too close to each other, nor to those that stay.
  bool far_apart(const std::vector<Eigen::Vector3d>& positions) const;
  // Moves all of them to allowed places, far apart. Says whether it could; if not they are left anywhere.
  bool settle(std::vector<Eigen::Vector3d>& positions) const;

 private:
  struct MountedSurface {
    NearestSurface surface;
    double clearance = 0, tolerance = 0;  // metres
  };
  static bool is_in_front(const MountedSurface& mount, const NearestPoint& near, const Eigen::Vector3d& position);
  Eigen::Vector3d in_front_of(const MountedSurface& mount, const Eigen::Vector3d& position) const;
  bool hangs_on(const MountedSurface& mount, const Eigen::Vector3d& position) const;
  bool clear_of_surfaces(const Eigen::Vector3d& position) const;
  Eigen::Vector3d away_from_surfaces(const Eigen::Vector3d& position) const;
  void push_apart(std::vector<Eigen::Vector3d>& positions) const;

  PlaceRules rules_;
  std::vector<renderer::Box3f> boxes_;
  std::vector<std::shared_ptr<const MountedSurface>> mounts_;
  std::shared_ptr<const NearestSurface> surfaces_;  // absent: they may be near
  std::vector<Eigen::Vector3d> stay_;
};

}  // namespace chiaro::inverse

#pragma once
// What a user allows lights to be, as options or as a file (docs/constraints.md).

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "inverse/transport/allowed_places.h"

namespace chiaro::inverse {

// What is absent is not constrained.
struct LightConstraints {
  std::optional<int> lights, max_lights;
  std::vector<Region> regions;
  std::vector<Mount> mounts;
  std::optional<double> surface_distance, light_distance;  // metres
  std::optional<double> max_intensity;                     // candela
  std::optional<std::array<double, 2>> kelvin;
  bool one_color = false, keep_lights = false, keep_positions = false;
};

// Error, naming the key, where a value is missing, of the wrong kind or out of range.
LightConstraints load_constraints(const std::filesystem::path& path);

// Those of `stronger` where it has any, else those of `weaker`; regions and mounts belong together.
LightConstraints merged(const LightConstraints& stronger, const LightConstraints& weaker);

}  // namespace chiaro::inverse

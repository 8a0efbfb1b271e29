#pragma once
// What a user allows lights to be, as options or as a file (docs/constraints.md).

#include <array>
#include <filesystem>
#include <functional>
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

// Two constraints that exclude each other, whatever the scene.
struct Contradiction {
  std::string key;     // of the one that had better go, as a file has it
  std::string reason;  // names both
};

// name: what the user calls the constraint of a key.
std::optional<Contradiction> find_contradiction(const LightConstraints& constraints,
                                                const std::function<std::string(const std::string& key)>& name);

// Error, naming the key, where a value is missing, of the wrong kind or out of range, or two exclude each other.
LightConstraints load_constraints(const std::filesystem::path& path);

// Those of `stronger` where it has any, else those of `weaker`; regions and mounts belong together.
LightConstraints merged(const LightConstraints& stronger, const LightConstraints& weaker);

}  // namespace chiaro::inverse

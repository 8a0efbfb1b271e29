#include "inverse/solve/light_constraints.h"

#include <fmt/format.h>

namespace chiaro::inverse {

std::optional<Contradiction> find_contradiction(const LightConstraints& constraints,
                                                const std::function<std::string(const std::string& key)>& name) {
  const LightConstraints& c = constraints;
  const auto exclude = [](const std::string& one, const std::string& other) {
    return fmt::format("{} and {} exclude each other", one, other);
  };
  if (c.lights && c.max_lights && *c.lights > *c.max_lights) {
    return Contradiction{"lights", exclude(fmt::format("{} {}", name("lights"), *c.lights),
                                           fmt::format("{} {}", name("max_lights"), *c.max_lights))};
  }
  if (!c.keep_positions) return std::nullopt;
  const auto with = [&](const std::string& key) {
    return Contradiction{"keep_positions", exclude(name("keep_positions"), name(key))};
  };
  if (c.keep_lights) return with("keep_lights");
  if (c.lights) return with("lights");
  if (c.max_lights) return with("max_lights");
  return std::nullopt;
}

LightConstraints merged(const LightConstraints& stronger, const LightConstraints& weaker) {
  LightConstraints both = stronger;
  const auto fill = [](auto& value, const auto& otherwise) {
    if (!value) value = otherwise;
  };
  fill(both.lights, weaker.lights);
  fill(both.max_lights, weaker.max_lights);
  fill(both.surface_distance, weaker.surface_distance);
  fill(both.light_distance, weaker.light_distance);
  fill(both.max_intensity, weaker.max_intensity);
  fill(both.kelvin, weaker.kelvin);
  if (both.regions.empty() && both.mounts.empty()) both.regions = weaker.regions, both.mounts = weaker.mounts;
  both.one_color |= weaker.one_color;
  both.keep_lights |= weaker.keep_lights;
  both.keep_positions |= weaker.keep_positions;
  return both;
}

}  // namespace chiaro::inverse

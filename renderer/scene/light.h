#pragma once
// Lights, in photometric units per Rec.709 channel. To add a kind: add a struct, list it in Light, and follow the
// compiler through the std::visit calls (trace/light_sampling, io/light_file, io/gltf_lights).

#include <concepts>
#include <memory>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "renderer/scene/environment_map.h"

namespace chiaro::renderer {

struct PointLight {
  std::string name;
  Vec3f position;   // metres
  Vec3f intensity;  // candela
};

// As KHR_lights_punctual: full inside the inner cone, a smooth fall to zero at the outer one.
struct SpotLight {
  std::string name;
  Vec3f position;
  Vec3f direction{0, 0, -1};             // unit, from the light outwards
  Vec3f intensity;                       // candela, on the axis
  float inner_cone_angle = 0;            // radians from the axis
  float outer_cone_angle = 0.78539816F;  // radians from the axis
};

struct DirectionalLight {
  std::string name;
  Vec3f direction{0, 0, -1};  // unit, the way the light travels
  Vec3f illuminance;          // lux, on a plane across the direction
};

// Light from infinitely far away, all around.
struct EnvironmentLight {
  std::string name;
  std::shared_ptr<const EnvironmentMap> map;
  float rotation = 0;   // radians about +Y
  float intensity = 1;  // radiance, cd/m², of a pixel of 1
  std::string image;    // the file that the map was read from; empty: none of its own
};

using Light = std::variant<PointLight, SpotLight, DirectionalLight, EnvironmentLight>;
using Lights = std::vector<Light>;

inline const std::string& name_of(const Light& light) {
  return std::visit([](const auto& l) -> const std::string& { return l.name; }, light);
}

// Candela, or lux of a directional light. Of Light or const Light; environments have none.
template <class AnyLight>
requires std::same_as<std::remove_const_t<AnyLight>, Light>
auto& intensity_of(AnyLight& light) {
  if (auto* point = std::get_if<PointLight>(&light)) return point->intensity;
  if (auto* spot = std::get_if<SpotLight>(&light)) return spot->intensity;
  return std::get<DirectionalLight>(light).illuminance;
}

inline bool is_environment(const Light& light) { return std::holds_alternative<EnvironmentLight>(light); }

}  // namespace chiaro::renderer

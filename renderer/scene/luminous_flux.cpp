#include "renderer/scene/luminous_flux.h"

#include <cmath>
#include <numbers>

namespace chiaro::renderer {
namespace {

using Flux = std::optional<double>;

Flux flux(const PointLight& light) { return 4 * std::numbers::pi * double(luminance(light.intensity)); }

// KHR_lights_punctual lets intensity fall with the square of a variable that is linear in the cosine: ∫ t² dt = 1/3.
Flux flux(const SpotLight& light) {
  const double inner = std::cos(double(light.inner_cone_angle)), outer = std::cos(double(light.outer_cone_angle));
  return 2 * std::numbers::pi * (1 - inner + (inner - outer) / 3) * double(luminance(light.intensity));
}

Flux flux(const DirectionalLight&) { return std::nullopt; }
Flux flux(const EnvironmentLight&) { return std::nullopt; }

}  // namespace

std::optional<double> luminous_flux(const Light& light) {
  return std::visit([](const auto& l) { return flux(l); }, light);
}

}  // namespace chiaro::renderer

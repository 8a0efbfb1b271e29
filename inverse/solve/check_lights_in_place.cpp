#include "inverse/solve/check_lights_in_place.h"

#include <limits>

#include <fmt/format.h>

#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/error.h"

namespace chiaro::inverse {
namespace {

struct PlacedLight {
  std::string name;
  Eigen::Vector3d position;
};

std::vector<PlacedLight> placed(const renderer::Lights& lights) {
  std::vector<PlacedLight> placed;
  const auto add = [&](const auto& light, std::size_t number) {
    const std::string name = light.name.empty() ? fmt::format("light {}", number + 1) : '"' + light.name + '"';
    placed.push_back({name, to_eigen(light.position)});
  };
  for (std::size_t j = 0; j < lights.size(); ++j) {
    if (const auto* point = std::get_if<renderer::PointLight>(&lights[j])) add(*point, j);
    if (const auto* spot = std::get_if<renderer::SpotLight>(&lights[j])) add(*spot, j);
  }
  return placed;
}

Box3f everywhere() {
  constexpr float kFar = std::numeric_limits<float>::max();
  return {{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};
}

[[noreturn]] void no_light_possible(const SolveProblem& problem, const std::string& why) {
  throw renderer::Error({problem.tracer.scene().path, "solve", "no light possible: " + why,
                         "lights that keep to the constraints where they are"});
}

void check_places(const SolveProblem& problem, const std::vector<PlacedLight>& lights, const PlaceRules& rules,
                  const std::string& where) {
  const AllowedPlaces places(problem.tracer.scene(), everywhere(), rules);
  for (const PlacedLight& light : lights) {
    if (places.contains(light.position)) continue;
    no_light_possible(problem, fmt::format("{} stays where it is, {}", light.name, where));
  }
}

void check_distances(const SolveProblem& problem, const std::vector<PlacedLight>& lights) {
  const double least = problem.places.light_distance;
  for (std::size_t j = 0; least > 0 && j < lights.size(); ++j) {
    for (std::size_t k = 0; k < j; ++k) {
      if ((lights[j].position - lights[k].position).norm() >= least) continue;
      no_light_possible(problem, fmt::format("{} stays where it is, and is not {} m apart from {}", lights[j].name,
                                             least, lights[k].name));
    }
  }
}

}  // namespace

void check_lights_in_place(const SolveProblem& problem) {
  const std::vector<PlacedLight> lights = placed(problem.lights_in_place);
  const PlaceRules& rules = problem.places;
  check_places(problem, lights, {.boxes = rules.boxes, .mounts = rules.mounts}, "outside all regions");
  check_places(problem, lights, {.surface_distance = rules.surface_distance},
               fmt::format("and that is not {} m from all surfaces", rules.surface_distance));
  check_distances(problem, lights);
}

}  // namespace chiaro::inverse

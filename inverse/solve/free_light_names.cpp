#include "inverse/solve/free_light_names.h"

#include <set>

#include <fmt/format.h>

namespace chiaro::inverse {
namespace {

std::set<std::string> names_in_use(const SolveProblem& problem) {
  std::set<std::string> names;
  for (const renderer::Light& light : problem.kept_lights) names.insert(renderer::name_of(light));
  for (const renderer::Instance& instance : problem.tracer.scene().instances) names.insert(instance.name);
  for (const renderer::Camera& camera : problem.tracer.scene().cameras) names.insert(camera.name);
  return names;
}

}  // namespace

std::vector<std::string> free_light_names(const SolveProblem& problem, std::size_t count) {
  const std::set<std::string> used = names_in_use(problem);
  std::vector<std::string> names;
  for (int number = 1; names.size() < count; ++number) {
    std::string name = fmt::format("light{}", number);
    if (!used.contains(name)) names.push_back(std::move(name));
  }
  return names;
}

}  // namespace chiaro::inverse

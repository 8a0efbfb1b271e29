#include "cli/solve_options.h"

#include <gtest/gtest.h>

#include "tests/support/code_scenes.h"

namespace chiaro::cli {
namespace {

using renderer::PointLight;

// A surface "light2" and a camera "light4".
renderer::Scene named_scene() {
  renderer::Scene scene;
  test::add_mesh(scene, test::rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), test::lambert({1, 1, 1}), "light2");
  scene.cameras.emplace_back().name = "light4";
  return scene;
}

std::vector<std::string> names_beside(const inverse::SolveProblem& problem) {
  inverse::SolveResult result;
  for (const char* name : {"light1", "light2", "light3"})
    result.lights.push_back({PointLight{name, {}, {}}, 0, {}, {}});
  name_apart(problem, result);
  std::vector<std::string> names;
  for (const inverse::FoundLight& found : result.lights) names.push_back(renderer::name_of(found.light));
  return names;
}

TEST(CliSolveOptions, LightsFoundHaveNamesOfTheirOwn) {
  const renderer::Scene scene = named_scene();
  const renderer::RayTracer tracer(scene);
  const inverse::Target target;
  inverse::SolveProblem problem{tracer, target, {}, {}, {}, {}};
  EXPECT_EQ(names_beside(problem), (std::vector<std::string>{"light1", "light3", "light5"}));
  problem.kept_lights = {PointLight{"light1", {}, {}}, PointLight{"lamp", {}, {}}};
  EXPECT_EQ(names_beside(problem), (std::vector<std::string>{"light3", "light5", "light6"}));
  problem.lights_in_place = {PointLight{"light2", {}, {}}};
  EXPECT_EQ(names_beside(problem), (std::vector<std::string>{"light1", "light2", "light3"}));
}

}  // namespace
}  // namespace chiaro::cli

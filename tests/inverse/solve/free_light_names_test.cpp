#include "inverse/solve/free_light_names.h"

#include <gtest/gtest.h>

#include "tests/support/code_scenes.h"

namespace chiaro::inverse {
namespace {

using renderer::PointLight;
using Names = std::vector<std::string>;

// A surface "light2" and a camera "light4".
renderer::Scene named_scene() {
  renderer::Scene scene;
  test::add_mesh(scene, test::rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), test::lambert({1, 1, 1}), "light2");
  scene.cameras.emplace_back().name = "light4";
  return scene;
}

TEST(FreeLightNames, AreThoseOfNothingElse) {
  const renderer::Scene scene = named_scene();
  const renderer::RayTracer tracer(scene);
  const Target target;
  SolveProblem problem{tracer, target, {}, {}, {}, {}};
  EXPECT_EQ(free_light_names(problem, 3), (Names{"light1", "light3", "light5"}));
  problem.kept_lights = {PointLight{"light1", {}, {}}, PointLight{"lamp", {}, {}}};
  EXPECT_EQ(free_light_names(problem, 3), (Names{"light3", "light5", "light6"}));
}

}  // namespace
}  // namespace chiaro::inverse

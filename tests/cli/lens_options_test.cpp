#include "cli/lens_options.h"

#include <gtest/gtest.h>

#include "tests/support/code_scenes.h"

namespace chiaro::cli {
namespace {

using renderer::Material;
using renderer::RayTracer;
using renderer::Scene;

// A wall five metres before the camera, which it faces, and one metre before it another, which shows its back.
Scene two_walls(const Material& front) {
  Scene scene;
  test::add_mesh(scene, test::rectangle({-9, -9, -5}, {18, 0, 0}, {0, 18, 0}), test::lambert({1, 1, 1}), "behind");
  test::add_mesh(scene, test::rectangle({-9, -9, -1}, {0, 18, 0}, {18, 0, 0}), front, "before");
  return scene;
}

float focus_distance(const Scene& scene) {
  LensOptions options;
  options.f_number = 1.4F;
  return lens_of(options, {}, RayTracer(scene)).focus_distance;
}

TEST(LensOptions, FocusIsOnWhatTheMiddleOfTheFrameShows) {
  Material hidden = test::lambert({1, 1, 1}), unlit = hidden;
  EXPECT_NEAR(focus_distance(two_walls(hidden)), 1, 1e-4F);
  hidden.hidden_back = true;
  EXPECT_NEAR(focus_distance(two_walls(hidden)), 5, 1e-4F);
  unlit.unlit = true;
  EXPECT_NEAR(focus_distance(two_walls(unlit)), 1, 1e-4F);
}

}  // namespace
}  // namespace chiaro::cli

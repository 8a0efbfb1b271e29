// Grids that are as coarse as an error of interpolation allows. Seeds are fixed.

#include "inverse/transport/grid_by_error.h"

#include <gtest/gtest.h>

#include "renderer/core/error.h"
#include "tests/support/code_scenes.h"

namespace chiaro::inverse {
namespace {

using renderer::RayTracer;
using renderer::Scene;

constexpr Box3f kRegion{{0.4F, 0.4F, 0.4F}, {3.6F, 2.6F, 3.6F}};
const BakeSettings kSettings{.samples = 32, .bounces = 2, .seed = 3, .materials = "gltf"};

class GridByError : public testing::Test {
 protected:
  std::size_t lights_for(double error, const BakeSettings& settings = kSettings) const {
    return choose_light_grid(tracer, receivers, {.region = kRegion, .error = error}, settings).positions.size();
  }
  Scene scene = test::corner_with_ball();
  RayTracer tracer{scene};
  Receivers receivers = make_receivers(scene, {.max_edge = 0.2F});
};

TEST_F(GridByError, IsTheUsualGridWithoutOne) {
  const LightGridOptions options{.counts = {3, 4, 5}, .region = kRegion};
  EXPECT_EQ(choose_light_grid(tracer, receivers, options, kSettings).positions,
            make_light_grid(tracer, options).positions);
}

TEST_F(GridByError, LessErrorTakesMoreLights) {
  const std::size_t coarse = lights_for(0.3), fine = lights_for(0.03);
  EXPECT_LE(coarse, 100U);
  EXPECT_GT(fine, 2 * coarse);
  EXPECT_EQ(lights_for(0.03), fine);
}

// A light inside a Lambertian sphere brings the same indirect light wherever it stands, and nothing hides it.
TEST_F(GridByError, IsCoarseWhereNothingChanges) {
  Scene sphere;
  test::add_mesh(sphere, test::sphere({0, 0, 0}, 2, 64, true), test::lambert({0.5F, 0.5F, 0.5F}), "sphere");
  const RayTracer inside(sphere);
  const Box3f middle{{-0.8F, -0.8F, -0.8F}, {0.8F, 0.8F, 0.8F}};
  const LightGrid grid = choose_light_grid(inside, make_receivers(sphere, {.max_edge = 0.5F}),
                                           {.region = middle, .error = 0.05}, kSettings);
  EXPECT_EQ(grid.positions.size(), 64U);
}

// Two corners of the room, and nothing between: as fine a grid as they take alone, and no light elsewhere.
TEST_F(GridByError, LooksOnlyWhereLightsMayStand) {
  const std::vector<Box3f> corners{{{0.4F, 2.0F, 0.4F}, {1, 2.6F, 1}}, {{3, 2.0F, 3}, {3.6F, 2.6F, 3.6F}}};
  const LightGrid grid =
      choose_light_grid(tracer, receivers, {.region = kRegion, .parts = corners, .error = 0.03}, kSettings);
  for (const Vec3f at : grid.positions) {
    const Vec3f reach = 0.51F * grid.spacing;
    EXPECT_TRUE(std::any_of(corners.begin(), corners.end(),
                            [&](const Box3f& corner) {
                              return Box3f{corner.min - reach, corner.max + reach}.contains(at);
                            }))
        << at.x << ' ' << at.y << ' ' << at.z;
  }
  EXPECT_GT(grid.positions.size(), 8U);
}

// The middle of the ball: its lights stand around it, and none between them.
TEST_F(GridByError, SaysWhenNoPlaceCanBeTested) {
  const Box3f middle{{2.1F, 0.5F, 1.7F}, {2.3F, 0.7F, 1.9F}};
  try {
    choose_light_grid(tracer, receivers, {.region = kRegion, .parts = {middle}, .error = 0.1}, kSettings);
    FAIL() << "a grid whose error nothing tells";
  } catch (const renderer::Error& e) {
    EXPECT_NE(std::string(e.what()).find("option --grid: no place"), std::string::npos) << e.what();
  }
}

TEST_F(GridByError, SaysWhenNoGridIsFineEnough) {
  EXPECT_THROW(lights_for(1e-5, {.samples = 4, .bounces = 0, .seed = 3, .materials = "gltf"}), renderer::Error);
}

}  // namespace
}  // namespace chiaro::inverse

#include "renderer/scene/environment_map.h"

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"
#include "tests/support/directions.h"

namespace chiaro::renderer {
namespace {

TEST(EnvironmentMap, TheTopIsUpAndTheMiddleLooksAlongX) {
  const auto expect = [](Vec3f direction, float u, float v) {
    const Vec2f uv = latlong_of(direction);
    EXPECT_NEAR(uv.x, u, 1e-6);
    EXPECT_NEAR(uv.y, v, 1e-6);
  };
  expect({1, 0, 0}, 0.5F, 0.5F);
  expect({0, 0, -1}, 0.25F, 0.5F);
  expect({0, 0, 1}, 0.75F, 0.5F);
  EXPECT_NEAR(latlong_of({0, 1, 0}).y, 0, 1e-6);
  EXPECT_NEAR(latlong_of({0, -1, 0}).y, 1, 1e-6);
}

TEST(EnvironmentMap, DirectionsComeBack) {
  for (std::uint32_t k = 0; k < 1000; ++k) {
    const Vec3f d = test::uniform_direction(Sampler(1, 0, k).next_2d());
    EXPECT_LT(length(direction_of_latlong(latlong_of(d)) - d), 1e-5F) << k;
  }
}

TEST(EnvironmentMap, LooksUpBetweenPixelsAllTheWayRound) {
  const EnvironmentMap map{
      4, 2, {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}, {6, 0, 0}, {7, 0, 0}, {8, 0, 0}}};
  EXPECT_FLOAT_EQ(look_up(map, {0.125F, 0.25F}).x, 1);
  EXPECT_FLOAT_EQ(look_up(map, {0.25F, 0.25F}).x, 1.5F);
  EXPECT_FLOAT_EQ(look_up(map, {0.25F, 0.5F}).x, 3.5F);
  EXPECT_FLOAT_EQ(look_up(map, {0.0F, 0.25F}).x, 2.5F);  // between the last and the first
  EXPECT_FLOAT_EQ(look_up(map, {1.0F, 0.25F}).x, 2.5F);
  EXPECT_FLOAT_EQ(look_up(map, {0.125F, 0.0F}).x, 1);  // level beyond the first row
  EXPECT_FLOAT_EQ(look_up(map, {0.125F, 1.0F}).x, 5);
}

TEST(EnvironmentMap, TurnsToTheLeftAsSeenFromWithin) {
  const Vec3f d = rotate_about_y({0, 0.6F, -0.8F}, kPi / 2);
  EXPECT_NEAR(d.x, -0.8F, 1e-6F);
  EXPECT_NEAR(d.y, 0.6F, 1e-6F);
  EXPECT_NEAR(d.z, 0, 1e-6F);
}

}  // namespace
}  // namespace chiaro::renderer

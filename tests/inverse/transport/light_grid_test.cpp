#include "inverse/transport/light_grid.h"

#include <gtest/gtest.h>

#include <atomic>

#include "inverse/transport/nearest_surface.h"
#include "renderer/core/error.h"
#include "tests/support/code_scenes.h"

namespace chiaro::inverse {
namespace {

using renderer::Error;
using renderer::RayTracer;
using renderer::Scene;

constexpr Vec3f kBall{2, 1.4F, 1.9F};
constexpr float kBallRadius = 0.8F;

Scene room_with_ball() {
  Scene scene;
  test::add_mesh(scene, test::room({4, 3, 4}, 2), test::lambert({0.5F, 0.5F, 0.5F}), "room");
  test::add_mesh(scene, test::sphere(kBall, kBallRadius, 24), test::lambert({0.5F, 0.5F, 0.5F}), "ball");
  return scene;
}

renderer::Mesh solid(const Box3f& box) {
  renderer::Mesh mesh = test::room(box.extent(), 2);
  for (Vec3f& p : mesh.positions) p += box.min;
  for (Vec3f& n : mesh.normals) n = -1.0F * n;
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

void expect_consistent(const LightGrid& grid) {
  ASSERT_EQ(grid.light_of_node.size(), std::size_t(grid.counts[0]) * grid.counts[1] * grid.counts[2]);
  std::size_t light = 0, node = 0;
  for (int z = 0; z < grid.counts[2]; ++z) {
    for (int y = 0; y < grid.counts[1]; ++y) {
      for (int x = 0; x < grid.counts[0]; ++x, ++node) {
        if (grid.light_of_node[node] < 0) continue;
        ASSERT_EQ(std::size_t(grid.light_of_node[node]), light);
        const Vec3f expected = grid.origin + grid.spacing * Vec3f{float(x), float(y), float(z)};
        EXPECT_LT(length(grid.positions[light++] - expected), 1e-5F);
      }
    }
  }
  EXPECT_EQ(light, grid.positions.size());
}

TEST(LightGrid, LeavesOutTheInsideOfSolidsAndNothingElse) {
  const Scene scene = room_with_ball();
  const RayTracer tracer(scene);
  const LightGrid grid = make_light_grid(tracer, {.counts = {13, 11, 12}, .region = {}});
  expect_consistent(grid);
  std::size_t node = 0, inside = 0;
  for (int z = 0; z < 12; ++z) {
    for (int y = 0; y < 11; ++y) {
      for (int x = 0; x < 13; ++x, ++node) {
        const Vec3f p = grid.origin + grid.spacing * Vec3f{float(x), float(y), float(z)};
        const float distance = length(p - kBall);
        if (distance > kBallRadius * 0.99F && distance < kBallRadius * 1.03F) continue;  // may touch the surface
        EXPECT_EQ(grid.light_of_node[node] < 0, distance < kBallRadius) << distance;
        inside += distance < kBallRadius * 0.99F ? 1 : 0;
      }
    }
  }
  EXPECT_GT(inside, 30U);
}

TEST(LightGrid, RandomPositionsAreInTheRegionAndNotInSolids) {
  const Scene scene = room_with_ball();
  const RayTracer tracer(scene);
  const Box3f region{{1, 0.5F, 1}, {3, 2.5F, 3}};
  const std::vector<Vec3f> positions = random_light_positions(tracer, region, 400, 1);
  ASSERT_EQ(positions.size(), 400U);
  int lower = 0;
  for (const Vec3f p : positions) {
    EXPECT_TRUE(region.contains(p));
    EXPECT_GT(length(p - kBall), 0.99F * kBallRadius);
    lower += p.y < 1.5F ? 1 : 0;
  }
  // The ball leaves 2.73 of the lower half's 4 m³, 3.13 of the upper's; five standard deviations.
  EXPECT_NEAR(lower, 400 * 2.73 / 5.86, 50);
}

// A tenth of a millimetre above the floor, which is nearer than what other regions' positions keep from surfaces.
TEST(LightGrid, RandomPositionsAreInThinRegionsBesideSurfaces) {
  const Scene scene = test::plane_scene({0.5F, 0.5F, 0.5F});
  const RayTracer tracer(scene);
  const Box3f region{{1, 1e-4F, 1}, {2, 2e-4F, 2}};
  const std::vector<Vec3f> positions = random_light_positions(tracer, region, 100, 1);
  EXPECT_EQ(positions.size(), 100U);
  for (const Vec3f p : positions) EXPECT_TRUE(region.contains(p));
}

TEST(LightGrid, StandsInTheMiddleOfTheRegionsCells) {
  const Scene scene = room_with_ball();
  const RayTracer tracer(scene);
  const Box3f region{{0.5F, 2.4F, 0.5F}, {3.5F, 2.8F, 2.5F}};
  const LightGrid grid = make_light_grid(tracer, {.counts = {6, 1, 4}, .region = region});
  expect_consistent(grid);
  EXPECT_EQ(grid.counts, (std::array<int, 3>{6, 1, 4}));
  EXPECT_EQ(grid.positions.size(), 24U);
  EXPECT_LT(length(grid.positions.front() - Vec3f{0.75F, 2.6F, 0.75F}), 1e-5F);
  EXPECT_LT(length(grid.positions.back() - Vec3f{3.25F, 2.6F, 2.25F}), 1e-5F);
  for (const Vec3f p : grid.positions) EXPECT_TRUE(region.contains(p));
}

TEST(LightGrid, HasAboutAThousandLightsByDefaultInsideTheScene) {
  for (const Vec3f size : {Vec3f{4, 3, 4}, Vec3f{20, 2, 5}, Vec3f{0.003F, 0.002F, 0.004F}}) {
    Scene scene;
    test::add_mesh(scene, test::room(size, 2), test::lambert({0.5F, 0.5F, 0.5F}), "room");
    const RayTracer tracer(scene);
    const LightGrid grid = make_light_grid(tracer, {});
    expect_consistent(grid);
    EXPECT_GT(grid.positions.size(), 350U);
    EXPECT_LT(grid.positions.size(), 2000U);
    for (const Vec3f p : grid.positions) EXPECT_TRUE((Box3f{{0, 0, 0}, size}.contains(p)));
    // Cells are about cubes.
    EXPECT_LT(renderer::max_component(grid.spacing), 2 * renderer::min_component(grid.spacing));
  }
}

TEST(LightGrid, FlatRegionsHaveOneLayer) {
  const Scene scene = room_with_ball();
  const RayTracer tracer(scene);
  const LightGrid grid =
      make_light_grid(tracer, {.counts = {}, .region = Box3f{{0.5F, 2.5F, 0.5F}, {3.5F, 2.5F, 3.5F}}});
  expect_consistent(grid);
  EXPECT_EQ(grid.counts[1], 1);
  EXPECT_GT(grid.counts[0], 10);
  for (const Vec3f p : grid.positions) EXPECT_EQ(p.y, 2.5F);
}

TEST(LightGrid, CanBeInterrupted) {
  const Scene scene = room_with_ball();
  const RayTracer tracer(scene);
  const std::atomic<bool> interrupted{true};
  const renderer::Control control{.report = {}, .report_noise = {}, .interrupted = &interrupted};
  EXPECT_THROW(make_light_grid(tracer, {}, control), renderer::Interruption);
}

TEST(LightGrid, WithoutFreeSpaceIsAnError) {
  const Scene scene = room_with_ball();
  const RayTracer tracer(scene);
  const Box3f inside{kBall - Vec3f{0.3F, 0.3F, 0.3F}, kBall + Vec3f{0.3F, 0.3F, 0.3F}};
  try {
    make_light_grid(tracer, {.counts = {3, 3, 3}, .region = inside});
    FAIL() << "a grid inside a solid";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no light possible"), std::string::npos) << error.what();
  }
}

// The part's own cell has its node inside the ball.
TEST(LightGrid, SmallPartsBesideSolidsHaveTheLightsAroundThem) {
  const Scene scene = room_with_ball();
  const RayTracer tracer(scene);
  const Vec3f above = kBall + Vec3f{0, kBallRadius, 0};
  const Box3f part{above - Vec3f{0.01F, 0.01F, 0.01F}, above + Vec3f{0.01F, 0.01F, 0.01F}};
  const LightGrid grid = make_light_grid(tracer, {.counts = {3, 2, 3}, .parts = {part}});
  ASSERT_FALSE(grid.positions.empty());
  for (const Vec3f p : grid.positions) EXPECT_GT(length(p - kBall), kBallRadius);
}

// Spaced as the region's length asks for, every node lies inside the beam.
TEST(LightGrid, ThinRegionsHaveLightsInWhatASolidLeavesOfThem) {
  Scene scene = room_with_ball();
  const Box3f beam{{0.5F, 1, 1}, {3.5F, 1.02F, 1.02F}};
  test::add_mesh(scene, solid(beam), test::lambert({0.5F, 0.5F, 0.5F}), "beam");
  const RayTracer tracer(scene);
  const Box3f region{beam.min, {beam.max.x, 1.024F, beam.max.z}};
  const LightGrid grid = make_light_grid(tracer, {.counts = {}, .region = region, .lights = 60});
  expect_consistent(grid);
  ASSERT_FALSE(grid.positions.empty());
  for (const Vec3f p : grid.positions) EXPECT_GT(p.y, beam.max.y);
}

TEST(LightGrid, RoomsWithWallsTurnedOutwardsStillHaveLights) {
  Scene scene;
  test::add_mesh(scene, solid({{0, 0, 0}, {4, 3, 4}}), test::lambert({0.5F, 0.5F, 0.5F}), "room");
  const RayTracer tracer(scene);
  EXPECT_EQ(make_light_grid(tracer, {.counts = {5, 5, 5}, .region = {}}).positions.size(), 125U);
}

TEST(ParseRegion, TakesSixNumbersOrANodesName) {
  Scene scene = room_with_ball();
  scene.instances[1].world_from_object = renderer::make_transform({10, 0, 0}, {0, 0, 0, 1}, {1, 1, 1});
  EXPECT_EQ(parse_region(scene, {"1,2,3,4,5,6"}).max, (Vec3f{4, 5, 6}));
  EXPECT_EQ(parse_region(scene, {"4,-5,6,1,2,3"}).min, (Vec3f{1, -5, 3}));
  EXPECT_EQ(parse_region(scene, {"1e-3,0,0,1,1,1"}).min.x, 1e-3F);
  const Box3f ball = parse_region(scene, {"ball"});
  EXPECT_LT(length(ball.center() - (kBall + Vec3f{10, 0, 0})), 0.02F);
  EXPECT_NEAR(ball.extent().y, 2 * kBallRadius, 0.01F);
}

TEST(ParseRegion, TakesAllThatHangsOnANode) {
  Scene scene = room_with_ball();
  scene.instances.push_back(scene.instances[1]);
  scene.instances[2].world_from_object = renderer::make_transform({10, 0, 0}, {0, 0, 0, 1}, {1, 1, 1});
  scene.nodes = {{"lamps", -1}, {"one", 0}, {"other", 1}};
  scene.instances[1].node = 1;
  scene.instances[2].node = 2;
  EXPECT_NEAR(parse_region(scene, {"lamps"}).extent().x, 10 + 2 * kBallRadius, 0.02F);
  EXPECT_NEAR(parse_region(scene, {"one"}).extent().x, 10 + 2 * kBallRadius, 0.02F);
  EXPECT_NEAR(parse_region(scene, {"other"}).extent().x, 2 * kBallRadius, 0.02F);
  EXPECT_NEAR(renderer::bounds_of_node(scene, "lamps").extent().x, 10 + 2 * kBallRadius, 0.02F);
}

TEST(ParseRegion, RefusesAFlatNode) {
  Scene scene = room_with_ball();
  scene.instances[1].world_from_object = renderer::make_transform({}, {0, 0, 0, 1}, {1, 1e-9F, 1});
  try {
    parse_region(scene, {"ball"});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(error.parts().problem.find("\"ball\" is flat"), std::string::npos);
  }
}

TEST(ParseRegion, RefusesTheRestByItsText) {
  const Scene scene = room_with_ball();
  for (const char* text : {"", "bal", "1,2,3", "1,2,3,4,5", "1,2,3,4,5,6,7", "1,2,3,4,5,six", "1,2,3,4,5,6 ",
                           "nan,0,0,1,1,1", "0,0,0,inf,1,1", "1;2;3;4;5;6"}) {
    try {
      parse_region(scene, {text});
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_NE(error.parts().place.find("--region"), std::string::npos);
      EXPECT_NE(error.parts().problem.find(std::string("\"") + text + "\""), std::string::npos);
    }
  }
}

TEST(ParseRegion, RefusesThatOfAFileByItsPlaceThere) {
  const Scene scene = room_with_ball();
  for (const char* text : {"bal", "1,2,3,1,2,3"}) {
    try {
      parse_region(scene, {text, {"limits.json", "regions[2]"}});
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.parts().file, "limits.json");
      EXPECT_EQ(error.parts().place, "regions[2]");
    }
  }
}

}  // namespace
}  // namespace chiaro::inverse

#include "inverse/transport/light_response.h"

#include <gtest/gtest.h>

#include "inverse/transport/bake.h"
#include "inverse/transport/receivers.h"
#include "renderer/core/sampler.h"
#include "tests/support/code_scenes.h"

namespace chiaro::inverse {
namespace {

using Eigen::Vector3d;
using renderer::RayTracer;
using renderer::Scene;
using renderer::SurfaceSample;

// In an empty room every light sees every receiver: the visibility is fixed.
Scene empty_room() {
  Scene scene;
  test::add_mesh(scene, test::room({4, 3, 4}, 2), test::lambert({0.6F, 0.5F, 0.4F}), "room");
  return scene;
}

BakeSettings settings(int samples, int bounces) {
  BakeSettings s;
  s.samples = samples;
  s.bounces = bounces;
  return s;
}

Vector3d random_position(std::uint32_t number, const Box3f& box) {
  renderer::Sampler sampler(1, number, 0);
  const renderer::Vec2f xy = sampler.next_2d();
  const Vec3f p = box.min + box.extent() * Vec3f{xy.x, xy.y, sampler.next_1d()};
  return {p.x, p.y, p.z};
}

class ResponseOfARoom : public ::testing::Test {
 protected:
  const Scene scene_ = empty_room();
  const RayTracer tracer_{scene_};
  const Receivers receivers_ = make_receivers(scene_, {.max_edge = 1});
  const LightGrid grid_ = make_light_grid(tracer_, {.counts = {4, 3, 5}, .region = {}});
  const TransportCache cache_ = bake(tracer_, receivers_, grid_, settings(8, 2)).cache;
  const GatherOperator gather_ = make_gather_operator(tracer_, receivers_.samples, {.samples = 64});
  const LightResponse response_{tracer_, receivers_.samples, cache_, &gather_};
};

TEST_F(ResponseOfARoom, TheNearestGridLightsStandInForPlacesFarFromAll) {
  const LightGrid corner = make_light_grid(tracer_, {.counts = {8, 6, 8}, .parts = {{{0, 0, 0}, {0.5F, 0.5F, 0.5F}}}});
  const TransportCache cache = bake(tracer_, receivers_, corner, settings(8, 0)).cache;
  const AllowedPlaces places(scene_, corner.region, {.boxes = {{{3, 2, 3}, {3.5F, 2.5F, 3.5F}}}});
  const LightResponse response(tracer_, receivers_.samples, cache, places);
  EXPECT_FALSE(response.grid_lights_near_places().empty());
  EXPECT_EQ(response.places_near_grid_lights().size(), response.grid_lights_near_places().size());
  for (const Vector3d& place : response.places_near_grid_lights()) EXPECT_TRUE(places.contains(place));
}

// Exact values have steps where a light comes so close to a gather point that its whole cell counts: there the two
// one-sided differences are not alike.
TEST_F(ResponseOfARoom, GradientEqualsCentralDifferences) {
  constexpr double kStep = 0.02;  // of the gradient
  int smooth = 0, all = 0;
  for (std::uint32_t k = 0; k < 12; ++k) {
    const Vector3d x = random_position(k, grid_.region);
    for (const auto evaluation : {Evaluation::kTracedVisibility, Evaluation::kInterpolated, Evaluation::kExact}) {
      // Gathered light is in floats.
      const bool gathered = evaluation == Evaluation::kExact;
      const double step = gathered ? 1e-3 : 1e-4, most = gathered ? 1e-2 : 1e-4;
      const ColumnWithGradient at = response_.evaluate_with_gradient(x, evaluation);
      for (int a = 0; a < 3; ++a) {
        const Column plus = response_.evaluate_with_gradient(Vector3d(x + step * Vector3d::Unit(a)), evaluation).value;
        const Column minus = response_.evaluate_with_gradient(Vector3d(x - step * Vector3d::Unit(a)), evaluation).value;
        const Column difference = (plus - minus) / (2 * step);
        const double scale = at.gradient[std::size_t(a)].norm();
        ++all;
        if (gathered && (plus - 2 * at.value + minus).norm() / step > kStep * scale) continue;
        ++smooth;
        EXPECT_LT((difference - at.gradient[std::size_t(a)]).norm(), most * scale)
            << "position " << k << ", axis " << a;
      }
    }
  }
  EXPECT_GT(smooth, 0.9 * all);
}

TEST_F(ResponseOfARoom, EveryWayToEvaluateAgrees) {
  for (std::uint32_t k = 100; k < 112; ++k) {
    const Vector3d x = random_position(k, grid_.region);
    const Column value = response_.evaluate(x, Evaluation::kTracedVisibility);
    const Column with_gradient = response_.evaluate_with_gradient(x, Evaluation::kTracedVisibility).value;
    EXPECT_LT((value - with_gradient).norm(), 1e-5 * value.norm());
    EXPECT_LT((value - response_.evaluate(x, Evaluation::kInterpolated)).norm(), 1e-5 * value.norm());
    EXPECT_GT(response_.interpolated_indirect(x).minCoeff(), 0);
    const Column exact = response_.evaluate(x, Evaluation::kExact);
    EXPECT_LT((exact - response_.evaluate_with_gradient(x, Evaluation::kExact).value).norm(), 1e-6 * exact.norm());
  }
}

TEST_F(ResponseOfARoom, AtANodeItIsTheBakedColumn) {
  for (const std::size_t light : {std::size_t{0}, grid_.positions.size() / 2, grid_.positions.size() - 1}) {
    const Vec3f p = grid_.positions[light];
    const Column baked = response_.grid_column(light);
    EXPECT_LT((response_.evaluate(Vector3d{p.x, p.y, p.z}, Evaluation::kTracedVisibility) - baked).norm(),
              1e-5 * baked.norm());
    EXPECT_LT((response_.evaluate(Vector3d{p.x, p.y, p.z}, Evaluation::kInterpolated) - baked).norm(),
              1e-5 * baked.norm());
  }
}

TEST_F(ResponseOfARoom, DirectPartIsTheClosedForm) {
  const TransportCache direct = bake(tracer_, receivers_, grid_, settings(1, 0)).cache;
  const LightResponse response(tracer_, receivers_.samples, direct);
  const Vec3f lamp{1.3F, 1.1F, 2.6F};
  const Column column = response.evaluate(Vector3d{lamp.x, lamp.y, lamp.z}, Evaluation::kTracedVisibility);
  for (std::size_t i = 0; i < receivers_.size(); ++i) {
    const SurfaceSample& at = receivers_.samples[i];
    const Vec3f d = lamp - at.position;
    const double expected = double(dot(d, at.normal)) / (M_PI * std::pow(double(length(d)), 3));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(column(Eigen::Index(i), c), expected, 1e-5 * expected);
  }
}

// Room of the fixture; a spot's light is what the path tracer says, too.
TEST_F(ResponseOfARoom, ExactEvaluationIsWhatIlluminateTraces) {
  constexpr int kPaths = 4096;
  renderer::PointLight lamp;
  lamp.position = {1.3F, 1.1F, 2.6F};
  lamp.intensity = {1, 1, 1};
  renderer::SpotLight spot;
  spot.position = {2.2F, 2.1F, 1.4F};
  spot.direction = normalize(Vec3f{-0.4F, -1, 0.3F});
  spot.intensity = {1, 1, 1};
  spot.inner_cone_angle = 0.3F;
  spot.outer_cone_angle = 0.9F;
  const auto expect_as_traced = [&](const renderer::Light& light, const UnityLight& unity) {
    const auto traced = trace_illumination(tracer_, receivers_.samples, {light}, {kPaths, -1, 11, false});
    const Column exact = response_.evaluate(unity, Evaluation::kExact);
    double difference = 0, noise = 0, norm = 0;
    for (std::size_t i = 0; i < receivers_.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        const double expected = double(traced.value[i][c]);
        difference += std::pow(exact(Eigen::Index(i), c) - expected, 2);
        noise += std::pow(double(traced.standard_error[i][c]), 2);
        norm += expected * expected;
      }
    }
    // Ours is of 64 rays and 2048 gather points.
    EXPECT_LT(std::sqrt(difference / norm), 3 * std::sqrt(noise / norm) + 0.02);
  };
  expect_as_traced(lamp, Vector3d(1.3F, 1.1F, 2.6F));
  expect_as_traced(spot, {Vector3d(2.2F, 2.1F, 1.4F), spot_cone(spot)});
}

// A cache of one receiver whose indirect part is a function of the light's position.
template <class F>
TransportCache cache_of(const LightGrid& grid, const F& indirect) {
  TransportCache cache;
  cache.grid = grid;
  cache.receiver_count = 1;
  for (const Vec3f p : grid.positions) {
    cache.visibility.push_back(0);
    cache.indirect.push_back(indirect(p));
  }
  return cache;
}

// Looks away from every light: its direct part is 0.
std::vector<SurfaceSample> receiver_below() { return {{{2, -1, 2}, {0, -1, 0}}}; }

LightGrid regular_grid(const std::vector<int>& left_out) {
  LightGrid grid;
  grid.region = {{0, 0, 0}, {4, 3, 5}};
  grid.counts = {4, 3, 5};
  grid.spacing = {1, 1, 1};
  grid.origin = {0.5F, 0.5F, 0.5F};
  for (int node = 0; node < 60; ++node) {
    const bool out = std::find(left_out.begin(), left_out.end(), node) != left_out.end();
    grid.light_of_node.push_back(out ? -1 : int(grid.positions.size()));
    const Vec3f at{float(node % 4), float(node / 4 % 3), float(node / 12)};
    if (!out) grid.positions.push_back(grid.origin + at);
  }
  return grid;
}

Scene room_of_the_grid() {
  Scene scene;
  test::add_mesh(scene, test::room({4, 3, 5}, 2), test::lambert({0.6F, 0.5F, 0.4F}), "room");
  return scene;
}

TEST(LightResponse, WeightsSumToOneEverywhereAlsoNearLeftOutNodes) {
  const Scene scene = room_of_the_grid();
  const RayTracer tracer(scene);
  // A block of 2 × 2 × 2 nodes, so that some cells have lost all corners; and some single ones.
  for (const std::vector<int>& left_out : {std::vector<int>{}, {17, 18, 21, 22, 29, 30, 33, 34}, {0, 5, 26, 59}}) {
    const LightGrid grid = regular_grid(left_out);
    const TransportCache cache = cache_of(grid, [](Vec3f) { return Vec3f{1, 2, 3}; });
    const LightResponse response(tracer, receiver_below(), cache);
    const Box3f around{{-1, -1, -1}, {5, 4, 6}};
    for (std::uint32_t k = 0; k < 500; ++k) {
      const Vector3d x = random_position(k, around);
      const Column column = response.interpolated_indirect(x);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(column(0, c), c + 1, 1e-9);
      const ColumnWithGradient with = response.evaluate_with_gradient(x, Evaluation::kInterpolated);
      EXPECT_LT((with.value - column).norm(), 1e-9);
      for (const Column& g : with.gradient) EXPECT_LT(g.norm(), 1e-9);
    }
  }
}

TEST(LightResponse, ReproducesLinearFieldsAndTheirSlopes) {
  const Scene scene = room_of_the_grid();
  const RayTracer tracer(scene);
  const LightGrid grid = regular_grid({});
  const TransportCache cache = cache_of(grid, [](Vec3f p) { return Vec3f{p.x, 1 + 2 * p.y, p.x + p.y + p.z}; });
  const LightResponse response(tracer, receiver_below(), cache);
  const Box3f nodes{{0.51F, 0.51F, 0.51F}, {3.49F, 2.49F, 4.49F}};
  for (std::uint32_t k = 0; k < 200; ++k) {
    const Vector3d x = random_position(k, nodes);
    const ColumnWithGradient at = response.evaluate_with_gradient(x, Evaluation::kInterpolated);
    EXPECT_NEAR(at.value(0, 0), x.x(), 1e-6);
    EXPECT_NEAR(at.value(0, 1), 1 + 2 * x.y(), 1e-6);
    EXPECT_NEAR(at.value(0, 2), x.sum(), 1e-6);
    EXPECT_NEAR(at.gradient[0](0, 0), 1, 1e-6);
    EXPECT_NEAR(at.gradient[1](0, 1), 2, 1e-6);
    for (const Column& g : at.gradient) EXPECT_NEAR(g(0, 2), 1, 1e-6);
    EXPECT_NEAR(at.gradient[0](0, 1), 0, 1e-6);
  }
}

TEST(LightResponse, BeyondTheGridTakesItsBorder) {
  const Scene scene = room_of_the_grid();
  const RayTracer tracer(scene);
  const TransportCache cache = cache_of(regular_grid({}), [](Vec3f p) { return p; });
  const LightResponse response(tracer, receiver_below(), cache);
  const ColumnWithGradient at = response.evaluate_with_gradient(Vector3d{-3, 1.25, 9}, Evaluation::kInterpolated);
  EXPECT_NEAR(at.value(0, 0), 0.5, 1e-6);
  EXPECT_NEAR(at.value(0, 1), 1.25, 1e-6);
  EXPECT_NEAR(at.value(0, 2), 4.5, 1e-6);
  EXPECT_NEAR(at.gradient[0](0, 0), 0, 1e-9);
  EXPECT_NEAR(at.gradient[1](0, 1), 1, 1e-6);
  EXPECT_NEAR(at.gradient[2](0, 2), 0, 1e-9);
}

TEST(LightResponse, TracedVisibilityKnowsShadows) {
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  const std::vector<SurfaceSample> floor{{{2.2F, 0, 1.8F}, {0, 1, 0}}, {{3.8F, 0, 3.8F}, {0, 1, 0}}};
  const LightGrid grid = make_light_grid(tracer, {.counts = {2, 2, 2}, .region = {}});
  TransportCache cache;
  cache.grid = grid;
  cache.receiver_count = 2;
  cache.visibility.assign(2 * grid.positions.size(), 1);
  cache.indirect.assign(2 * grid.positions.size(), Vec3f{});
  const LightResponse response(tracer, floor, cache);
  const Column column = response.evaluate(Vector3d{2.2, 2.5, 1.8}, Evaluation::kTracedVisibility);
  EXPECT_EQ(column(0, 0), 0);  // under the ball
  EXPECT_GT(column(1, 0), 0);
}

}  // namespace
}  // namespace chiaro::inverse

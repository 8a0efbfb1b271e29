// What a bake computes, against closed forms and against the path tracer. Seeds are fixed.

#include "inverse/transport/bake.h"

#include <gtest/gtest.h>

#include "inverse/transport/gather_operator.h"
#include "inverse/transport/light_response.h"
#include "tests/support/code_scenes.h"
#include "tests/support/mean.h"

namespace chiaro::inverse {
namespace {

using renderer::RayTracer;
using renderer::Scene;
using renderer::SurfaceSample;

constexpr float kRadius = 2, kAlbedo = 0.6F;

Scene lambert_sphere() {
  Scene scene;
  test::add_mesh(scene, test::sphere({0, 0, 0}, kRadius, 96, true), test::lambert({kAlbedo, kAlbedo / 2, 0}), "sphere");
  return scene;
}

// Middles of triangles all over a mesh.
std::vector<SurfaceSample> surface_points(const renderer::Mesh& mesh, std::size_t count) {
  std::vector<SurfaceSample> points;
  for (std::size_t k = 0; k < count; ++k) {
    const renderer::Triangle& t = mesh.triangles[(2 * k + 1) * mesh.triangles.size() / (2 * count)];
    const Vec3f a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
    points.push_back({(a + b + c) / 3, normalize(cross(b - a, c - a))});
  }
  return points;
}

double mean_of(const std::vector<LightBlock>& blocks, int channel, int light) {
  double sum = 0;
  for (const LightBlock& block : blocks) sum += double(block.channel[channel][light]);
  return sum / double(blocks.size());
}

BakeSettings settings(int samples, int bounces) {
  BakeSettings s;
  s.samples = samples;
  s.bounces = bounces;
  s.materials = "gltf";
  return s;
}

TEST(GatherOperator, IndirectLightInALambertSphereIsTheGeometricSeriesEverywhere) {
  // n bounces of a light of 1 cd bring (a + a² + … + aⁿ) / (π R²), wherever the light stands.
  const Scene scene = lambert_sphere();
  const RayTracer tracer(scene);
  const auto receivers = surface_points(scene.meshes[0], 300);
  const Vec3f outward = normalize(Vec3f{0.36F, 0.48F, -0.8F});
  const double depths[3] = {1, 0.5, 0.1};  // of the lights below the wall, in radii
  std::vector<Vec3f> lights;
  for (const double depth : depths) lights.push_back((float(1 - depth) * kRadius) * outward);
  const double direct = 1 / (M_PI * kRadius * kRadius);
  for (const int bounces : {1, 2, -1}) {
    const GatherOperator gather = make_gather_operator(
        tracer, receivers, {.samples = 128, .points_per_sample = 16, .bounces = bounces, .seed = 3});
    const auto indirect = indirect_illumination(tracer, gather, lights);
    ASSERT_EQ(indirect.size(), receivers.size());
    for (int channel = 0; channel < 2; ++channel) {
      const double a = channel == 0 ? double(kAlbedo) : double(kAlbedo) / 2;
      const double series = bounces < 0 ? a / (1 - a) : bounces == 1 ? a : a + a * a;
      for (int light = 0; light < 3; ++light) {
        EXPECT_NEAR(mean_of(indirect, channel, light) / (series * direct), 1, 0.02) << bounces << ", light " << light;
        double squares = 0;
        for (const LightBlock& block : indirect) {
          squares += std::pow(double(block.channel[channel][light]) / (series * direct) - 1, 2);
        }
        // One bounce gathered by N rays: ∫ E² over the wall, h below which the light stands, makes their relative
        // variance about R² / (8 h² N).
        const double bound = 0.03 + std::sqrt(1 / (8 * depths[light] * depths[light] * 128));
        EXPECT_LT(std::sqrt(squares / double(indirect.size())), bound) << bounces << ", light " << light;
      }
    }
    EXPECT_EQ(mean_of(indirect, 2, 0), 0);  // nothing is blue
    EXPECT_EQ(mean_of(indirect, 0, 3), 0);  // no fourth light was asked for
  }
}

TEST(GatherOperator, WithoutBouncesBringsNothing) {
  const Scene scene = lambert_sphere();
  const RayTracer tracer(scene);
  const auto receivers = surface_points(scene.meshes[0], 10);
  const GatherOperator gather = make_gather_operator(tracer, receivers, {.bounces = 0});
  EXPECT_TRUE(gather.points.empty());
  EXPECT_EQ(gather.ray_count, 0U);
  const std::vector<Vec3f> light{{2, 2, 2}};
  const auto indirect = indirect_illumination_by_light(tracer, gather, light);
  ASSERT_EQ(indirect.size(), 1U);
  EXPECT_EQ(indirect[0], std::vector<Vec3f>(receivers.size()));
}

// A room with a crate so high above its floor, and sunk into it, no wall of which is lit from within.
Scene room_with_crate(float height) {
  Scene scene;
  const renderer::Material grey = test::lambert({0.7F, 0.7F, 0.7F});
  test::add_mesh(scene, test::room({4, 3, 4}), grey, "room");
  renderer::Mesh crate = test::room({0.6F, height + 0.1F, 0.6F});
  for (Vec3f& position : crate.positions) position += Vec3f{1.7F, -0.1F, 1.7F};
  test::add_mesh(scene, std::move(crate), grey, "crate");
  return scene;
}

// Of the floor within that crate, in parts of what the rest of it gets.
double light_inside_crate(const Scene& scene) {
  const RayTracer tracer(scene);
  std::vector<SurfaceSample> receivers;  // on the floor, every 10 cm
  for (int x = 1; x < 40; ++x) {
    for (int z = 1; z < 40; ++z) receivers.push_back({{0.1F * float(x), 0, 0.1F * float(z)}, {0, 1, 0}});
  }
  const GatherOperator gather = make_gather_operator(tracer, receivers, {.samples = 64, .points_per_sample = 8});
  const auto indirect = indirect_illumination(tracer, gather, std::vector<Vec3f>{{2, 2, 2}});
  test::Mean lit, inside;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const Vec3f p = receivers[i].position;
    const bool in_crate = std::abs(p.x - 2) < 0.25F && std::abs(p.z - 2) < 0.25F;
    (in_crate ? inside : lit).add(double(indirect[i].channel[0][0]));
  }
  EXPECT_EQ(inside.count, 25);
  EXPECT_GT(lit.value(), 0);
  return inside.value() / lit.value();
}

TEST(GatherOperator, NoLightLeaksIntoClosedCrates) { EXPECT_LT(light_inside_crate(room_with_crate(0.4F)), 1e-3); }

// Gather points are 20 cm apart here: far more than the gap.
TEST(GatherOperator, NoLightLeaksBelowWhatLiesOnAFloor) {
  EXPECT_LT(light_inside_crate(room_with_crate(0.003F)), 1e-3);
}

TEST(GatherOperator, AdjointGivesTheSameLight) {
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  const std::vector<SurfaceSample> receivers{{{1, 0, 3}, {0, 1, 0}}, {{3, 0, 1}, {0, 1, 0}}, {{2, 0, 3.5F}, {0, 1, 0}}};
  const std::vector<std::size_t> some{2, 0};
  const std::vector<Vec3f> lights{{3, 2, 3}, {0.5F, 0.1F, 2}};
  for (const int bounces : {0, 1, 3, -1}) {
    const GatherOperator gather =
        make_gather_operator(tracer, receivers, {.samples = 64, .points_per_sample = 8, .bounces = bounces, .seed = 3});
    const std::vector<LightBlock> importance = importance_of_gather_points(gather, some);
    const std::vector<LightBlock> forward = indirect_illumination(tracer, gather, lights);
    for (std::size_t light = 0; light < lights.size(); ++light) {
      const auto adjoint = indirect_illumination_at(tracer, gather, importance, some.size(), lights[light]);
      for (std::size_t k = 0; k < some.size() && bounces != 0; ++k) {
        for (int c = 0; c < 3; ++c) {
          const float expected = forward[some[k]].channel[c][light];
          EXPECT_GT(expected, 0);
          // Both leave out 1e-4 of the bounces' light altogether, of one receiver some more.
          EXPECT_NEAR(adjoint[k][c], expected, 5e-4 * expected) << bounces;
        }
      }
      if (bounces == 0) {
        EXPECT_EQ(adjoint[0], (Vec3f{0, 0, 0}));
      }
    }
  }
}

TEST(GatherOperator, SameLightForAnyNumberOfThreads) {
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  const std::vector<SurfaceSample> receivers{{{1, 0, 3}, {0, 1, 0}}, {{3, 0, 1}, {0, 1, 0}}, {{2, 0, 3.5F}, {0, 1, 0}}};
  const GatherOptions options{.samples = 16, .points_per_sample = 8, .bounces = -1, .seed = 3};
  const std::vector<Vec3f> lights{{3, 2, 3}};
  std::vector<std::vector<LightBlock>> results;
  for (const int threads : {1, 2}) {
    const renderer::ThreadLimit limit(threads);
    results.push_back(indirect_illumination(tracer, make_gather_operator(tracer, receivers, options), lights));
  }
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    EXPECT_GT(results[0][i].channel[0][0], 0);
    EXPECT_EQ(results[0][i].channel[0][0], results[1][i].channel[0][0]);
    EXPECT_EQ(results[0][i].channel[2][0], results[1][i].channel[2][0]);
  }
}

class BakedCorner : public ::testing::Test {
 protected:
  BakedCorner()
      : receivers_(make_receivers(scene_, {.max_edge = 0.4F})),
        grid_(make_light_grid(tracer_, {.counts = {4, 3, 4}, .region = {}})) {}

  // Illumination by grid lights of these intensities, as baked.
  std::vector<Vec3f> baked(const TransportCache& cache,
                           const std::vector<std::pair<std::size_t, Vec3f>>& lights) const {
    const LightResponse response(tracer_, receivers_.samples, cache);
    std::vector<Vec3f> sum(receivers_.size());
    for (const auto& [light, intensity] : lights) {
      const Column column = response.grid_column(light);
      for (std::size_t i = 0; i < sum.size(); ++i) {
        const auto row = Eigen::Index(i);
        sum[i] += intensity * Vec3f{float(column(row, 0)), float(column(row, 1)), float(column(row, 2))};
      }
    }
    return sum;
  }

  renderer::Lights point_lights(const std::vector<std::pair<std::size_t, Vec3f>>& lights) const {
    renderer::Lights result;
    for (const auto& [light, intensity] : lights) {
      result.push_back(renderer::PointLight{"", grid_.positions[light], intensity});
    }
    return result;
  }

  const Scene scene_ = test::corner_with_ball();
  const RayTracer tracer_{scene_};
  const Receivers receivers_;
  const LightGrid grid_;
  const std::vector<std::pair<std::size_t, Vec3f>> lights_{{40, {10, 5, 2}}, {22, {3, 3, 9}}, {31, {1, 8, 4}}};
};

TEST_F(BakedCorner, DirectColumnsAreThePathTracers) {
  const TransportCache cache = bake(tracer_, receivers_, grid_, settings(16, 0)).cache;
  const auto sum = baked(cache, lights_);
  const auto traced =
      trace_illumination(tracer_, receivers_.samples, point_lights(lights_), {.samples = 1, .bounces = 0});
  std::size_t different = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (length(sum[i] - traced.value[i]) > 1e-4F * length(traced.value[i])) ++different;
  }
  EXPECT_LE(different, sum.size() / 250);  // shadow rays the other way round, through edges
  EXPECT_EQ(cache.indirect_relative_error, 0);
  for (const Vec3f v : cache.indirect) EXPECT_EQ(v, Vec3f{});
}

TEST_F(BakedCorner, SuperpositionOfColumnsIsThePathTracersLight) {
  const auto traced =
      trace_illumination(tracer_, receivers_.samples, point_lights(lights_), {.samples = 512, .seed = 8});
  const auto direct =
      trace_illumination(tracer_, receivers_.samples, point_lights(lights_), {.samples = 1, .bounces = 0});
  double difference = 0, noise = 0, indirect = 0, all = 0, squared_stated = 0;
  Vec3f mean_baked, mean_traced;
  for (const std::uint64_t seed : {0, 1, 2}) {
    BakeSettings seeded = settings(256, -1);
    seeded.seed = seed;
    const TransportCache cache = bake(tracer_, receivers_, grid_, seeded).cache;
    const auto sum = baked(cache, lights_);
    for (std::size_t i = 0; i < sum.size(); ++i) {
      const Vec3f traced_indirect = traced.value[i] - direct.value[i];
      const Vec3f baked_indirect = sum[i] - direct.value[i];
      difference += double(length_squared(baked_indirect - traced_indirect));
      noise += double(length_squared(traced.standard_error[i]));
      indirect += double(length_squared(traced_indirect));
      all += double(length_squared(traced.value[i]));
      mean_baked += baked_indirect, mean_traced += traced_indirect;
    }
    EXPECT_GT(cache.indirect_relative_error, 0);
    EXPECT_LT(cache.indirect_relative_error, 0.1);
    squared_stated += cache.indirect_relative_error * cache.indirect_relative_error / 3;
  }
  // The stated error is that of six other lights, and varies by a third from seed to seed; half as much again for
  // these.
  EXPECT_LT(std::sqrt(std::max(0.0, difference - noise) / indirect), 1.5 * std::sqrt(squared_stated));
  EXPECT_LT(std::sqrt(difference / all), 0.03);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean_baked[c] / mean_traced[c], 1, 0.02);
}

TEST_F(BakedCorner, SamplesLowerTheStatedError) {
  double errors[2];
  for (const int k : {0, 1}) {
    errors[k] = bake(tracer_, receivers_, grid_, settings(k == 0 ? 16 : 256, -1)).cache.indirect_relative_error;
  }
  EXPECT_LT(errors[1], 0.6 * errors[0]);
}

TEST_F(BakedCorner, SaysWhatItIsOfAndWhatItCost) {
  const BakeResult result = bake(tracer_, receivers_, grid_, settings(16, 1));
  EXPECT_EQ(result.cache.scene_fingerprint, renderer::fingerprint(scene_));
  EXPECT_EQ(result.cache.receiver_fingerprint, fingerprint(receivers_));
  EXPECT_EQ(result.cache.settings.samples, 16);
  EXPECT_EQ(result.cache.settings.bounces, 1);
  EXPECT_EQ(result.cache.receiver_count, receivers_.size());
  EXPECT_EQ(result.cache.indirect.size(), receivers_.size() * grid_.positions.size());
  EXPECT_GT(result.summary.shadow_rays, 0U);
  EXPECT_LE(result.summary.shadow_rays, receivers_.size() * grid_.positions.size());
  EXPECT_GE(result.summary.gather_rays, receivers_.size() * 16);
  EXPECT_GT(result.summary.gather_points, 0U);
}

// Files have half floats, which end: with the ground outside lights brought more than they hold, times the scale.
TEST_F(BakedCorner, TheScaleOfFilesIsThatOfTheRoomHoweverLargeTheGround) {
  const float alone = bake(tracer_, receivers_, grid_, settings(16, 1)).cache.indirect_scale;
  Scene on_ground = scene_;
  test::add_mesh(on_ground, test::rectangle({-5e4F, -0.1F, -5e4F}, {0, 0, 1e5F}, {1e5F, 0, 0}),
                 test::lambert({0.5F, 0.5F, 0.5F}), "ground");
  const RayTracer tracer(on_ground);
  const float scale = bake(tracer, receivers_, grid_, settings(16, 1)).cache.indirect_scale;
  EXPECT_GE(scale, alone / 4);
  EXPECT_LE(scale, 64 * alone);
}

TEST_F(BakedCorner, SameEntriesForAnyNumberOfThreads) {
  std::vector<TransportCache> caches;
  for (const int threads : {1, 2}) {
    const renderer::ThreadLimit limit(threads);
    caches.push_back(bake(tracer_, receivers_, grid_, settings(16, -1)).cache);
  }
  EXPECT_EQ(caches[0].indirect, caches[1].indirect);
  EXPECT_EQ(caches[0].visibility, caches[1].visibility);
  EXPECT_EQ(caches[0].indirect_relative_error, caches[1].indirect_relative_error);
}

}  // namespace
}  // namespace chiaro::inverse

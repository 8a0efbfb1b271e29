// Monte Carlo integrals over directions; bounds are five standard errors (p < 0.0001 %) where nothing else is said.

#include "renderer/trace/light_sampling.h"

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"
#include "tests/support/code_scenes.h"
#include "tests/support/directions.h"
#include "tests/support/mean.h"

namespace chiaro::renderer {
namespace {

using test::add_mesh;
using test::lambert;
using test::Mean;
using test::rectangle;
using test::uniform_direction;

void expect_near(const Mean& mean, double expected) { EXPECT_NEAR(mean.value(), expected, 5 * mean.error() + 1e-4); }

// A glowing box around the origin and a bright panel in it, both drawn through transforms; one wall is dark.
Scene glowing_scene() {
  Scene scene;
  Mesh box = test::room({2, 1, 1}, 2);
  add_mesh(scene, box, lambert({0, 0, 0}, {1, 2, 3}), "box");
  scene.instances[0].world_from_object = make_transform({2, -1, -1}, {0, 0, 0, 1}, {-2, 2, 3});  // mirrored
  add_mesh(scene, rectangle({-0.2F, 0, -0.2F}, {0.4F, 0, 0}, {0, 0, 0.4F}), lambert({0, 0, 0}, {50, 50, 50}), "panel");
  scene.instances[1].world_from_object = make_transform({0.5F, 0.6F, 0.4F}, {0, 0, 0, 1}, {0.5F, 1, 2});
  return scene;
}

// All surfaces that a line of sight passes through, near and far.
std::vector<Hit> all_hits(const RayTracer& tracer, Vec3f from, Vec3f direction) {
  std::vector<Hit> hits;
  float near = 0;
  while (const auto hit = tracer.intersect({from, direction, near, kInfinity, 0})) {
    hits.push_back(*hit);
    near = hit->distance * 1.0001F;
  }
  return hits;
}

TEST(EmissiveTriangles, DensityIntegratesToOneOverAllDirections) {
  const Scene scene = glowing_scene();
  const RayTracer tracer(scene);
  const EmissiveTriangles emitters(scene);
  for (const Vec3f from : {Vec3f{0, 0, 0}, Vec3f{0.5F, 0.5F, 0.4F}, Vec3f{-1.9F, -0.9F, 1.9F}}) {
    Mean mean;
    for (std::uint32_t k = 0; k < 1U << 16; ++k) {
      const Vec3f direction = uniform_direction(Sampler(1, 0, k).next_2d());
      double pdf = 0;
      for (const Hit& hit : all_hits(tracer, from, direction)) {
        pdf += double(emitters.pdf(hit, from, {}, from + hit.distance * direction));
      }
      mean.add(4 * M_PI * pdf);
    }
    expect_near(mean, 1);
  }
}

TEST(EmissiveTriangles, SamplesCarryTheirOwnDensityAndRadiance) {
  const Scene scene = glowing_scene();
  const RayTracer tracer(scene);
  const EmissiveTriangles emitters(scene);
  const Vec3f from{0.5F, 0.5F, 0.4F};
  Mean solid_angle;
  for (std::uint32_t k = 0; k < 1U << 15; ++k) {
    Sampler sampler(2, 0, k);
    const float pick = sampler.next_1d();
    const EmissiveTriangles::Sample s = emitters.sample(from, {}, pick, sampler.next_2d());
    if (!(s.pdf > 0)) continue;
    EXPECT_NEAR(length(s.to_light), 1, 1e-5F);
    // What stands at the sampled distance is what was sampled.
    const auto hit = tracer.intersect({from, s.to_light, s.distance * 0.999F, s.distance * 1.001F, 0});
    ASSERT_TRUE(hit) << k;
    EXPECT_NEAR(emitters.pdf(*hit, from, {}, from + hit->distance * s.to_light) / s.pdf, 1, 5e-3F);
    EXPECT_EQ(s.radiance, hit->instance == 0 ? Vec3f({1, 2, 3}) : Vec3f({50, 50, 50}));
    if (hit->instance == 0) solid_angle.add(1 / double(s.pdf));
    if (hit->instance == 1) solid_angle.add(0);
  }
  // The box is all around: ∫ dω over it is 4π.
  EXPECT_NEAR(solid_angle.value(), 4 * M_PI, 5 * solid_angle.error());
}

// Shadow rays end before the triangle that they go to, wherever it is and however it lies.
TEST(EmissiveTriangles, ShadowRaysDoNotMeetTheTriangleThatTheyGoTo) {
  int rays = 0, met = 0;
  for (std::uint32_t scene_index = 0; scene_index < 200; ++scene_index) {
    Sampler sampler(6, 1, scene_index);
    const float away = std::pow(10.0F, 4 * sampler.next_1d() - 1), size = std::pow(10.0F, 3 * sampler.next_1d() - 2);
    const auto direction = [&] { return uniform_direction(sampler.next_2d()); };
    const Vec3f corner = away * direction();
    Scene scene;
    add_mesh(scene, rectangle(corner, size * direction(), size * direction()), lambert({0, 0, 0}, {1, 1, 1}), "panel");
    const RayTracer tracer(scene);
    const EmissiveTriangles emitters(scene);
    for (int k = 0; k < 500; ++k) {
      const Vec3f from = corner + 10 * size * sampler.next_1d() * direction();
      const auto s = emitters.sample(from, {}, double(sampler.next_1d()), sampler.next_2d());
      if (!(s.pdf > 0)) continue;
      ++rays;
      met += tracer.occluded({from, s.to_light, 0, s.reach, 0}) ? 1 : 0;
    }
  }
  EXPECT_GT(rays, 90000);
  EXPECT_LT(met, rays / 1000);
}

TEST(EmissiveTriangles, PicksByPowerAndSkipsTheDark) {
  // Two equal squares of luminance 1 : 3 at the same distance, and a dark one.
  Scene scene;
  add_mesh(scene, rectangle({-3, 0, 0}, {1, 0, 0}, {0, 1, 0}), lambert({0, 0, 0}, {1, 1, 1}), "dim");
  add_mesh(scene, rectangle({2, 0, 0}, {1, 0, 0}, {0, 1, 0}), lambert({0, 0, 0}, {3, 3, 3}), "bright");
  add_mesh(scene, rectangle({0, 5, 0}, {1, 0, 0}, {0, 1, 0}), lambert({1, 1, 1}), "dark");
  const EmissiveTriangles emitters(scene);
  int bright = 0;
  constexpr int kSamples = 4096;
  for (std::uint32_t k = 0; k < kSamples; ++k) {
    Sampler sampler(3, 0, k);
    const double pick = double(sampler.next_1d());
    const auto s = emitters.sample({0, 0.5F, 4}, {}, pick, sampler.next_2d());
    ASSERT_GT(s.radiance.x, 0);
    bright += s.radiance.x == 3 ? 1 : 0;
  }
  EXPECT_NEAR(double(bright) / kSamples, 0.75, 0.01);
  EXPECT_TRUE(EmissiveTriangles(test::corner_with_ball()).empty());
  EXPECT_FALSE(emitters.empty());
}

// One candela each, however small the lamp.
TEST(EmissiveTriangles, ShineHoweverSmallTheyAre) {
  for (const float edge : {1e-3F, 1e-10F, 1e-12F}) {
    Scene scene;
    const float luminance = 1 / (edge * edge);
    add_mesh(scene, rectangle({0, 0, 0}, {edge, 0, 0}, {0, edge, 0}),
             lambert({0, 0, 0}, {luminance, luminance, luminance}), "lamp");
    const auto s = EmissiveTriangles(scene).sample({0, 0, 2}, {}, 0.5, {0.3F, 0.7F});
    ASSERT_GT(s.pdf, 0) << edge;
    EXPECT_NEAR(s.radiance.x / s.pdf, 0.25F, 1e-4F) << edge;  // of a distance of two metres
  }
}

TEST(EmissiveTriangles, PicksTheNearAndWhatTheSurfaceFaces) {
  Scene scene;
  add_mesh(scene, rectangle({-0.5F, 1, -0.5F}, {1, 0, 0}, {0, 0, 1}), lambert({0, 0, 0}, {1, 1, 1}), "near");
  add_mesh(scene, rectangle({-0.5F, 100, -0.5F}, {1, 0, 0}, {0, 0, 1}), lambert({0, 0, 0}, {1, 1, 1}), "far");
  add_mesh(scene, rectangle({-0.5F, -1, -0.5F}, {1, 0, 0}, {0, 0, 1}), lambert({0, 0, 0}, {1, 1, 1}), "behind");
  const EmissiveTriangles emitters(scene);
  int near = 0;
  constexpr int kSamples = 1024;
  for (std::uint32_t k = 0; k < kSamples; ++k) {
    Sampler sampler(3, 0, k);
    const double pick = double(sampler.next_1d());
    const auto s = emitters.sample({0, 0, 0}, {0, 1, 0}, pick, sampler.next_2d());
    if (!(s.pdf > 0)) continue;
    EXPECT_GT(s.to_light.y, 0);
    near += s.distance < 2 ? 1 : 0;
  }
  EXPECT_GT(near, 0.9 * kSamples);
}

Lights punctual_lights() {
  return {PointLight{"", {1, 2, 3}, {10, 5, 1}},
          SpotLight{"", {0, 1, 0}, normalize(Vec3f{1, -2, 0.5F}), {20, 30, 20}, 0.2F, 0.6F},
          DirectionalLight{"", {0, -1, 0}, {1000, 1000, 1000}}, PointLight{"black", {0, 0, 0}, {0, 0, 0}}};
}

TEST(PunctualEmission, DensityIntegratesToOneOverLightsAndDirections) {
  const Lights lights = punctual_lights();
  const PunctualEmission emission(lights);
  Mean mean;
  for (std::uint32_t k = 0; k < 1U << 17; ++k) {
    const Vec3f direction = uniform_direction(Sampler(4, 0, k).next_2d());
    double pdf = 0;
    for (std::size_t i = 0; i < lights.size(); ++i) pdf += double(emission.pdf(i, direction));
    mean.add(4 * M_PI * pdf);
  }
  expect_near(mean, 1);
  EXPECT_EQ(emission.pdf(2, {0, -1, 0}), 0);
  EXPECT_EQ(emission.pdf(3, {0, -1, 0}), 0);
}

TEST(PunctualEmission, RaysCarryTheLightsFlux) {
  // E[intensity / pdf] over the rays of one light = its flux, lumens.
  const Lights lights = punctual_lights();
  const PunctualEmission emission(lights);
  std::vector<Mean> flux(lights.size());
  for (std::uint32_t k = 0; k < 1U << 16; ++k) {
    Sampler sampler(5, 0, k);
    const float pick = sampler.next_1d();
    const auto s = emission.sample(pick, sampler.next_2d());
    const float pdf = emission.pdf(s.light, s.direction);
    ASSERT_GT(pdf, 0);
    ASSERT_NEAR(length(s.direction), 1, 1e-5F);
    for (std::size_t i = 0; i < lights.size(); ++i) flux[i].add(i == s.light ? double(s.intensity.y / pdf) : 0);
  }
  expect_near(flux[0], 4 * M_PI * 5);
  // The spot: full within 0.2, then ((cos θ − cos 0.6) / (cos 0.2 − cos 0.6))², whose mean over that belt is 1/3.
  const double inner = std::cos(0.2), outer = std::cos(0.6);
  expect_near(flux[1], 30 * 2 * M_PI * (1 - inner + (inner - outer) / 3));
  EXPECT_EQ(flux[2].sum, 0);
  EXPECT_EQ(flux[3].sum, 0);
}

TEST(PunctualEmission, IsEmptyWhereNoLightHasAPlaceAndPower) {
  const Lights none{DirectionalLight{"", {0, -1, 0}, {1, 1, 1}}, PointLight{"", {0, 0, 0}, {0, 0, 0}}};
  EXPECT_TRUE(PunctualEmission(none).empty());
  EXPECT_FALSE(PunctualEmission(punctual_lights()).empty());
}

TEST(PunctualEmission, OfMoreLumensThanFloatsHoldStaysInRange) {
  const Lights lights{PointLight{"", {0, 0, 0}, {1, 1, 1}}, PointLight{"", {1, 0, 0}, {3e38F, 3e38F, 3e38F}}};
  const PunctualEmission emission(lights);
  for (const float pick : {1e-6F, 0.5F, 0.99999994F}) {
    EXPECT_EQ(emission.sample(pick, {0.5F, 0.5F}).light, 1U);
  }
  EXPECT_NEAR(emission.pdf(1, {0, 0, 1}), 1 / (4 * kPi), 1e-6F);
}

TEST(SamplePunctual, FollowsTheInverseSquareAndStaysFinite) {
  const Light light = PointLight{"", {1, 2, 3}, {8, 4, 2}};
  const PunctualSample s = sample_punctual(light, {1, 4, 3});
  EXPECT_EQ(s.to_light, (Vec3f{0, -1, 0}));
  EXPECT_FLOAT_EQ(s.distance, 2);
  EXPECT_FLOAT_EQ(s.irradiance.x, 2);
  EXPECT_FLOAT_EQ(s.irradiance.z, 0.5F);
  const PunctualSample at = sample_punctual(light, {1, 2, 3});
  EXPECT_TRUE(is_finite(at.to_light) && is_finite(at.irradiance));
  EXPECT_EQ(sample_punctual(DirectionalLight{"", {0, -1, 0}, {1, 2, 3}}, {9, 9, 9}).distance, kInfinity);
}

TEST(SamplePunctual, NarrowSpotsAreFullOnTheirAxis) {
  for (const float outer : {1.0F, 0.1F, 0.03F, 0.01F}) {
    const Light spot = SpotLight{"", {0, 0, 0}, {0, 0, -1}, {5, 5, 5}, 0.9F * outer, outer};
    EXPECT_NEAR(sample_punctual(spot, {0, 0, -1}).irradiance.x, 5, 1e-4) << outer;
  }
}

// Their cosines are all 1 in floats.
TEST(SamplePunctual, NarrowSpotsFallOffAsWideOnesDo) {
  for (const double outer : {1.0, 0.1, 1e-2, 1e-3, 1e-4}) {
    const Light spot = SpotLight{"", {0, 0, 0}, {0, 0, -1}, {4, 4, 4}, 0, float(outer)};
    for (const double part : {0.25, 0.5, 0.75}) {
      const double angle = part * outer, z = 1000;
      const auto versine = [](double a) { return 2 * std::pow(std::sin(a / 2), 2); };
      const double expected = 4e-6 * std::pow(std::cos(angle) * (1 - versine(angle) / versine(outer)), 2);
      const Vec3f at{float(z * std::tan(angle)), 0, float(-z)};
      EXPECT_NEAR(sample_punctual(spot, at).irradiance.x, expected, 2e-3 * expected) << outer << ' ' << part;
    }
  }
}

}  // namespace
}  // namespace chiaro::renderer

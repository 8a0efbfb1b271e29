#include "inverse/transport/bright_spot.h"

#include <cmath>

#include <gtest/gtest.h>

#include "inverse/transport/light_response.h"
#include "tests/support/code_scenes.h"

namespace chiaro::inverse {
namespace {

using renderer::RayTracer;
using renderer::Scene;
using renderer::SurfaceSample;

constexpr float kRadius = 2, kAlbedo = 0.6F;

// Indirect light in a Lambert sphere is a / (1 − a) / (π R²) cd⁻¹ everywhere, wherever the light stands.
class BrightSpotInASphere : public ::testing::Test {
 protected:
  BrightSpotInASphere() {
    test::add_mesh(scene_, test::sphere({0, 0, 0}, kRadius, 96, true), test::lambert({kAlbedo, kAlbedo, kAlbedo}),
                   "sphere");
    const renderer::Mesh& mesh = scene_.meshes[0];
    for (std::size_t k = 0; k < 400; ++k) {
      const renderer::Triangle& t = mesh.triangles[(2 * k + 1) * mesh.triangles.size() / 800];
      const Vec3f a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
      receivers_.push_back({(a + b + c) / 3, normalize(cross(b - a, c - a))});
    }
  }

  static Vec3f light_at(float depth) { return (kRadius - depth) * normalize(Vec3f{0.36F, 0.48F, -0.8F}); }

  Scene scene_;
  std::vector<SurfaceSample> receivers_;
};

struct Spread {
  double mean = 0, deviation = 0;  // relative to the closed form; root mean square about the mean
};

template <class Value>
Spread spread(std::size_t count, const Value& value) {
  const double expected = double(kAlbedo / (1 - kAlbedo)) / (M_PI * kRadius * kRadius);
  Spread of;
  for (std::size_t i = 0; i < count; ++i) of.mean += value(i) / expected / double(count);
  for (std::size_t i = 0; i < count; ++i) of.deviation += std::pow(value(i) / expected - of.mean, 2) / double(count);
  of.deviation = std::sqrt(of.deviation);
  return of;
}

TEST_F(BrightSpotInASphere, IsFoundByTheLightsRaysWhereTheReceiversFindLittleOfIt) {
  const RayTracer tracer(scene_);
  const GatherOperator gather =
      make_gather_operator(tracer, receivers_, {.samples = 128, .points_per_sample = 64, .seed = 3});
  for (const float depth : {0.05F, 0.1F, 0.2F}) {
    const std::vector<Vec3f> light{light_at(depth)};
    const auto plain = indirect_illumination(tracer, gather, light);
    const auto with = indirect_illumination_by_light(tracer, gather, light);
    const Spread of_plain = spread(receivers_.size(), [&](std::size_t i) { return double(plain[i].channel[0][0]); });
    const Spread of_with = spread(receivers_.size(), [&](std::size_t i) { return double(with[0][i].x); });
    EXPECT_NEAR(of_with.mean, 1, 0.03) << depth;  // the smallest spot is hardly larger than the cells in it
    EXPECT_LT(of_with.deviation, of_plain.deviation / 2) << depth;
  }
}

TEST_F(BrightSpotInASphere, OfALightFarFromAllSurfacesIsNone) {
  const RayTracer tracer(scene_);
  const GatherOperator gather =
      make_gather_operator(tracer, receivers_, {.samples = 32, .points_per_sample = 16, .seed = 3});
  const std::vector<float> direct(gather.points.size(), 1);
  for (const Vec3f change : change_by_bright_spot(tracer, gather, {0, 0, 0}, direct)) EXPECT_EQ(change, Vec3f{});
}

}  // namespace
}  // namespace chiaro::inverse

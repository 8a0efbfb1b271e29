#include "renderer/trace/bsdf.h"

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"
#include "tests/support/layered_points.h"

namespace chiaro::renderer {
namespace {

using test::flat_point;
using test::mean_reflected;

const float kMaterials[][2] = {{0, 1}, {0, 0.3F}, {0.5F, 0.5F}, {1, 0.2F}, {1, 1}};  // metallic, roughness
const Vec3f kViewers[] = {{0, 0, 1}, normalize(Vec3f{1, 0, 1}), normalize(Vec3f{1, 0.3F, 0.2F})};

TEST(Bsdf, DensityIntegratesToWhatSamplingKeeps) {
  // ∫ pdf over the hemisphere = probability that sample() returns a direction; cosine-weighted quadrature of 2¹⁶
  // points.
  for (const auto& m : kMaterials) {
    for (const Vec3f& viewer : kViewers) {
      const Bsdf bsdf(flat_point({0.8F, 0.5F, 0.2F}, m[0], m[1]));
      double integral = 0, kept = 0;
      constexpr int kCount = 1 << 16;
      for (int i = 0; i < kCount; ++i) {
        Sampler sampler(1, 0, std::uint32_t(i));
        const Vec3f wi = sample_cosine_hemisphere(sampler.next_2d());
        if (wi.z > 0) integral += double(bsdf.pdf(viewer, wi) * kPi / wi.z) / kCount;
        const Vec2f u = sampler.next_2d();
        kept += bsdf.sample(viewer, u, sampler.next_1d()) ? 1.0 / kCount : 0;
      }
      EXPECT_NEAR(integral, kept, 0.02) << m[0] << ' ' << m[1] << ' ' << viewer.z;
    }
  }
}

TEST(Bsdf, SampledWeightIsEvaluationOverDensityAndConservesEnergy) {
  for (const auto& m : kMaterials) {
    for (const Vec3f& viewer : kViewers) {
      const Bsdf bsdf(flat_point({1, 1, 1}, m[0], m[1]));
      double albedo = 0;
      constexpr int kCount = 1 << 16;
      for (int i = 0; i < kCount; ++i) {
        Sampler sampler(2, 0, std::uint32_t(i));
        const Vec2f u = sampler.next_2d();
        const auto s = bsdf.sample(viewer, u, sampler.next_1d());
        if (!s) continue;
        const float expected = bsdf.eval(viewer, s->direction).y / bsdf.pdf(viewer, s->direction);
        EXPECT_NEAR(s->weight.y, expected, 1e-3F * expected + 1e-6F);
        albedo += double(s->weight.y) / kCount;
      }
      EXPECT_NEAR(albedo, 1, 0.002) << m[0] << ' ' << m[1] << ' ' << viewer.z;  // white loses nothing
    }
  }
}

TEST(Bsdf, IsReciprocal) {
  const Vec3f a = normalize(Vec3f{0.5F, 0.2F, 0.7F}), b = normalize(Vec3f{-0.3F, 0.6F, 0.4F});
  for (const auto& m : kMaterials) {
    const Bsdf bsdf(flat_point({0.8F, 0.5F, 0.2F}, m[0], m[1]));
    EXPECT_NEAR(bsdf.eval(a, b).x / b.z, bsdf.eval(b, a).x / a.z, 1e-5F);
  }
}

TEST(Bsdf, LambertIsItsBaseColour) {
  SurfacePoint point = flat_point({0.8F, 0.5F, 0.2F}, 1, 0);
  point.lambert = true;
  EXPECT_EQ(hemispherical_albedo(point), point.base_color);
  const Bsdf bsdf(point);
  EXPECT_FLOAT_EQ(bsdf.eval({0, 0, 1}, {0, 0, 1}).y, 0.5F / kPi);
  EXPECT_EQ(bsdf.eval({0, 0, 1}, {0, 0, -1}), Vec3f{});
}

TEST(Bsdf, HemisphericalAlbedoIsTheMeanOfSampledWeights) {
  for (const auto& m : kMaterials) {
    const SurfacePoint point = flat_point({0.6F, 0.6F, 0.6F}, m[0], m[1]);
    EXPECT_NEAR(hemispherical_albedo(point).x, mean_reflected(point, 1 << 15), 0.005);
  }
}

TEST(Bsdf, DiffuseLightFadesBeforeTheSmoothSurfaceTurnsAway) {
  SurfacePoint point = flat_point({1, 1, 1}, 0, 1);
  point.lambert = true;
  point.shading_normal = normalize(Vec3f{1, 0, 1});
  const Bsdf bsdf(point);
  const Vec3f viewer{0, 0, 1}, above = normalize(Vec3f{-1, 0, 1.5F}), below = normalize(Vec3f{1, 0, 0.001F});
  // Steeper to the turned normal than to the smooth one: all of it. On the smooth surface's horizon: almost nothing.
  const float cosine = dot(above, point.shading_normal);
  EXPECT_NEAR(bsdf.eval(viewer, above).x, cosine * kInvPi, 1e-6F);
  EXPECT_LT(bsdf.eval(viewer, below).x, 0.005F * dot(below, point.shading_normal) * kInvPi);
  // In between g (1 + g − g²), with g the ratio of the cosines.
  const Vec3f between = normalize(Vec3f{1, 0, 0.5F});
  const float c = dot(between, point.shading_normal), g = between.z / (c * point.shading_normal.z);
  EXPECT_NEAR(bsdf.eval(viewer, between).x, c * kInvPi * g * (1 + g - g * g), 1e-6F);
}

}  // namespace
}  // namespace chiaro::renderer

// What the KHR_materials_* layers scatter. Quadrature and sampling are checked against each other and against what no
// surface may do. Seeds are fixed.

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"
#include "renderer/trace/bsdf.h"
#include "renderer/trace/fresnel.h"
#include "renderer/trace/specular_albedo.h"
#include "tests/support/directions.h"
#include "tests/support/layered_points.h"

namespace chiaro::renderer {
namespace {

using test::layered_point;
using test::layered_points;
using test::mean_reflected;
using test::NamedPoint;
using test::uniform_direction;

const Vec3f kViewers[] = {{0, 0, 1}, normalize(Vec3f{1, 0, 1}), normalize(Vec3f{1, 0.3F, 0.25F})};

bool goes_straight(const SurfacePoint& point, Vec3f viewer) { return max_component(Bsdf(point).straight(viewer)) > 0; }

struct Sampled {
  double albedo = 0, kept = 0;  // mean weight of green, and probability of a direction, of all samples
  double upper = 0;             // probability of one above the surface
  double error = 0;             // standard, of albedo
};

Sampled sampled(const Bsdf& bsdf, Vec3f viewer, int count) {
  Sampled sum;
  double squares = 0;
  for (int i = 0; i < count; ++i) {
    Sampler sampler(1, 0, std::uint32_t(i));
    const Vec2f u = sampler.next_2d();
    const auto s = bsdf.sample(viewer, u, sampler.next_1d());
    if (!s) continue;
    sum.albedo += double(s->weight.y) / count;
    squares += double(s->weight.y) * double(s->weight.y) / count;
    if (s->straight) continue;
    sum.kept += 1.0 / count;
    sum.upper += s->direction.z > 0 ? 1.0 / count : 0;
  }
  sum.error = std::sqrt(std::max(0.0, squares - sum.albedo * sum.albedo) / count);
  return sum;
}

TEST(BsdfLayers, SampledWeightIsEvaluationOverDensity) {
  for (const auto& [name, point] : layered_points({0.8F, 0.6F, 0.4F})) {
    const Bsdf bsdf(point);
    for (const Vec3f& viewer : kViewers) {
      for (int i = 0; i < 500; ++i) {
        Sampler sampler(2, 0, std::uint32_t(i));
        const Vec2f u = sampler.next_2d();
        const auto s = bsdf.sample(viewer, u, sampler.next_1d());
        if (!s || s->straight) continue;
        const float density = bsdf.pdf(viewer, s->direction);
        EXPECT_FLOAT_EQ(s->pdf, density) << name;
        const float expected = bsdf.eval(viewer, s->direction).y / density;
        EXPECT_NEAR(s->weight.y, expected, 1e-3F * expected) << name;
        EXPECT_TRUE(is_finite(s->weight) && min_component(s->weight) >= 0) << name;
      }
    }
  }
}

// Directions are sorted into cells of equal solid angle; χ² of the counts against the density's integral over each
// cell. Narrow lobes are left out: quadrature cannot follow them.
TEST(BsdfLayers, DirectionsAreSampledByTheirDensity) {
  constexpr int kRings = 10, kSectors = 8, kSamples = 20000, kInCell = 12;
  for (const auto& [name, point] : layered_points({0.8F, 0.6F, 0.4F})) {
    if (point.roughness < 0.5F) continue;
    const Vec3f viewer = kViewers[1];
    const Bsdf bsdf(point);
    const auto cell = [&](Vec3f w) {
      const int ring = std::min(kRings - 1, int((w.z + 1) * 0.5F * kRings));
      const float turn = 0.5F + std::atan2(w.y, w.x) / (2 * kPi);
      return ring * kSectors + std::min(kSectors - 1, int(turn * kSectors));
    };
    std::vector<double> observed(kRings * kSectors), expected(kRings * kSectors);
    for (int i = 0; i < kSamples; ++i) {
      const Vec2f u{unit_float(hash_combine(11, i)), unit_float(hash_combine(12, i))};
      // Of every direction that is sampled: those of no weight, which sample() leaves out, have none in eval() either.
      const auto s = bsdf.sample(viewer, u, unit_float(hash_combine(13, i)));
      if (s && !s->straight) observed[std::size_t(cell(s->direction))] += 1;
    }
    for (int r = 0; r < kRings * kInCell; ++r) {
      for (int k = 0; k < kSectors * kInCell; ++k) {
        const float z = (float(r) + 0.5F) / (kRings * kInCell) * 2 - 1;
        const float phi = ((float(k) + 0.5F) / (kSectors * kInCell) - 0.5F) * 2 * kPi, sine = std::sqrt(1 - z * z);
        const Vec3f wi{sine * std::cos(phi), sine * std::sin(phi), z};
        if (!(max_component(bsdf.eval(viewer, wi)) > 0)) continue;
        const double solid_angle = 4 * M_PI / (kRings * kInCell * kSectors * kInCell);
        expected[std::size_t(cell(wi))] += kSamples * double(bsdf.pdf(viewer, wi)) * solid_angle;
      }
    }
    double chi_square = 0;
    int cells = 0;
    for (std::size_t c = 0; c < expected.size(); ++c) {
      if (expected[c] < 5) continue;
      chi_square += (observed[c] - expected[c]) * (observed[c] - expected[c]) / expected[c];
      ++cells;
    }
    // Beyond mean + 5 standard deviations: less than one in 10⁵ for these degrees of freedom, and 40 cases.
    EXPECT_LT(chi_square, cells + 5 * std::sqrt(2.0 * cells)) << name << ", cells: " << cells;
  }
}

// White furnace: ∫ f |cosθ| over all directions by sampling is never more than what arrives. Radiance that enters a
// solid grows by the square of the refractive index, and the sum of what is reflected and let through counts both
// sides.
TEST(BsdfLayers, NothingSendsBackMoreThanItGets) {
  for (const auto& [name, point] : layered_points({1, 1, 1})) {
    for (const Vec3f& viewer : kViewers) {
      const Bsdf bsdf(point);
      const bool solid = point.layers->solid;
      const float scale = !solid ? 1 : point.front ? 1.5F * 1.5F : 1 / (1.5F * 1.5F);
      double albedo = 0;
      constexpr int kCount = 4096;
      for (int i = 0; i < kCount; ++i) {
        Sampler sampler(3, 0, std::uint32_t(i));
        const Vec2f u = sampler.next_2d();
        const auto s = bsdf.sample(viewer, u, sampler.next_1d());
        if (s) albedo += double(s->weight.x) * (s->direction.z < 0 ? double(scale) : 1.0) / kCount;
      }
      EXPECT_LT(albedo, 1.015) << name << ' ' << viewer.z;
    }
  }
}

// A coat has a normal of its own, whatever normal map is below it.
TEST(BsdfLayers, AClearcoatIsWhatItIsOverAnyNormalMap) {
  const Vec3f viewer = normalize(Vec3f{1, 0, 0.27F});
  SurfacePoint point = layered_point({0, 0, 0}, 0, 1);
  point.layers->specular = 0;
  point.layers->clearcoat = 1;
  point.layers->clearcoat_roughness = 0.2F;
  const double flat = sampled(Bsdf(point), viewer, 1 << 14).albedo;
  EXPECT_GT(flat, 0.1);
  for (const float tilt : {0.15F, 0.3F, 0.6F}) {
    point.shading_normal = {std::sin(tilt), 0, std::cos(tilt)};
    const Bsdf bsdf(point);
    EXPECT_NEAR(sampled(bsdf, viewer, 1 << 14).albedo / flat, 1, 0.02) << tilt;
    double whole = 0;
    for (int i = 0; i < 1 << 16; ++i) {
      const Vec2f u = Sampler(5, 0, std::uint32_t(i)).next_2d();
      const Vec3f d = sample_cosine_hemisphere(u);
      if (d.z > 1e-4F) whole += double(bsdf.eval(viewer, d).y) / (double(d.z) / M_PI) / (1 << 16);
    }
    EXPECT_NEAR(whole / flat, 1, 0.04) << tilt;
  }
}

TEST(BsdfLayers, WhiteSheetsLoseNothing) {
  for (const float roughness : {0.0F, 0.1F, 0.2F, 0.5F, 1.0F}) {
    SurfacePoint point = layered_point({1, 1, 1}, 0, roughness);
    point.layers->transmission = 1;
    for (const Vec3f& viewer : kViewers) {
      EXPECT_NEAR(sampled(Bsdf(point), viewer, 1 << 16).albedo, 1, 0.004) << roughness << ' ' << viewer.z;
    }
  }
}

// Rough ones too, as bright as polished ones: what facets scatter more than once comes out in the end.
TEST(BsdfLayers, WhiteMetalsLoseNothing) {
  for (const float roughness : {0.1F, 0.3F, 0.6F, 1.0F}) {
    const SurfacePoint point = layered_point({1, 1, 1}, 1, roughness);
    for (const Vec3f& viewer : kViewers) {
      EXPECT_NEAR(sampled(Bsdf(point), viewer, 1 << 16).albedo, 1, 0.004) << roughness << ' ' << viewer.z;
    }
    EXPECT_NEAR(hemispherical_albedo(point).y, 1, 0.002F) << roughness;
  }
}

// What is reflected and let through of each direction, both sides together, is all of it.
TEST(BsdfLayers, WhiteBoundariesLoseNothing) {
  for (const float roughness : {0.2F, 0.4F, 0.6F, 1.0F}) {
    for (const float ior : {1.2F, 1.5F, 2.4F}) {
      for (const bool front : {true, false}) {
        SurfacePoint point = layered_point({1, 1, 1}, 0, roughness);
        point.layers->transmission = 1;
        point.layers->solid = true;
        point.layers->ior = ior;
        point.front = front;
        const double eta = front ? double(ior) : 1 / double(ior);
        for (const Vec3f& viewer : kViewers) {
          double sum = 0;
          constexpr int kCount = 1 << 14;
          for (int i = 0; i < kCount; ++i) {
            Sampler sampler(6, 0, std::uint32_t(i));
            const Vec2f u = sampler.next_2d();
            const auto s = Bsdf(point).sample(viewer, u, sampler.next_1d());
            if (s) sum += double(s->weight.y) * (s->direction.z < 0 ? eta * eta : 1.0) / kCount;
          }
          EXPECT_NEAR(sum, 1, 0.008) << roughness << ' ' << ior << ' ' << front << ' ' << viewer.z;
        }
      }
    }
  }
}

// What a smooth boundary reflects and lets through are Fresnel's shares.
TEST(BsdfLayers, SmoothSolidsFollowFresnelAndSnell) {
  for (const bool front : {true, false}) {
    SurfacePoint point = layered_point({1, 1, 1}, 0, 0);
    point.layers->transmission = 1;
    point.layers->solid = true;
    point.front = front;
    const float eta = front ? 1.5F : 1 / 1.5F;
    for (const Vec3f& viewer : kViewers) {
      const float sine = std::sqrt(1 - viewer.z * viewer.z) / eta;
      double reflected = 0, sines = 0, through = 0;
      constexpr int kCount = 1 << 13;
      for (int i = 0; i < kCount; ++i) {
        Sampler sampler(4, 0, std::uint32_t(i));
        const Vec2f u = sampler.next_2d();
        const auto s = Bsdf(point).sample(viewer, u, sampler.next_1d());
        ASSERT_TRUE(s);
        if (s->direction.z > 0) {
          reflected += double(s->weight.x) / kCount;
        } else {
          EXPECT_NEAR(s->weight.x * eta * eta, 1, 0.01F);
          sines += double(std::hypot(s->direction.x, s->direction.y));
          through += 1;
        }
      }
      if (through > 0) {
        EXPECT_NEAR(sines / through, double(sine), 0.005);
      }
      EXPECT_NEAR(reflected, double(dielectric_reflectance(viewer.z, eta)), 0.01) << front << ' ' << viewer.z;
    }
  }
}

// Whoever picks lights by their cosine with it misses none that a coat above a normal map sees.
TEST(BsdfLayers, AllLightComesFromAboveTheHorizonOfTheLightNormal) {
  int from_anywhere = 0;
  for (const auto& [name, point] : layered_points({0.8F, 0.5F, 0.2F})) {
    const Bsdf bsdf(point);
    const Vec3f normal = bsdf.light_normal();
    if (normal == Vec3f{}) {
      from_anywhere += bsdf.transmits() ? 0 : 1;
      continue;
    }
    for (std::uint32_t i = 0; i < 2000; ++i) {
      Sampler sampler(5, 0, i);
      const Vec3f to_light = uniform_direction(sampler.next_2d());
      const bool lit = max_component(bsdf.eval(kViewers[0], to_light)) > 0;
      EXPECT_FALSE(lit && dot(normal, to_light) < -1e-4F) << name;
    }
  }
  EXPECT_GT(from_anywhere, 0);
}

TEST(BsdfLayers, AreReciprocal) {
  // Between two points of the same side, and through a sheet. Through a boundary, radiance over the square of the
  // index.
  const Vec3f a = normalize(Vec3f{0.5F, 0.2F, 0.7F}), b = normalize(Vec3f{-0.3F, 0.6F, 0.4F});
  for (const auto& [name, point] : layered_points({0.8F, 0.5F, 0.2F})) {
    if (point.layers->clearcoat_normal.z < 1) continue;  // normals of their own are not
    const Bsdf bsdf(point);
    const float ab = bsdf.eval(a, b).x / b.z, ba = bsdf.eval(b, a).x / a.z;
    EXPECT_NEAR(ab, ba, 2e-4F * ab + 1e-6F) << name;
    if (!point.layers->solid && !goes_straight(point, a)) {
      // From the other side the sheet is its mirror image.
      const Vec3f below{b.x, b.y, -b.z}, mirrored_a{a.x, a.y, -a.z};
      const float through = bsdf.eval(a, below).x / b.z, back = bsdf.eval(b, mirrored_a).x / a.z;
      EXPECT_NEAR(through, back, 2e-4F * through + 1e-6F) << name;
    }
  }
  SurfacePoint outside = layered_point({1, 1, 1}, 0, 0.5F);
  outside.layers->transmission = 1;
  outside.layers->solid = true;
  SurfacePoint inside = outside;
  inside.front = false;
  const Vec3f out = normalize(Vec3f{0.4F, 0, 0.8F}), in = normalize(Vec3f{-0.1F, 0.2F, -0.9F});
  // In the frame of the inside point the solid's inside is above.
  const Vec3f in_up{in.x, in.y, -in.z}, out_down{out.x, out.y, -out.z};
  const float entering = Bsdf(outside).eval(out, in).x / -in.z * (1.5F * 1.5F);
  const float leaving = Bsdf(inside).eval(in_up, out_down).x / out.z;
  EXPECT_GT(entering, 0.01F);
  EXPECT_NEAR(entering, leaving, 1e-3F * leaving);
}

TEST(BsdfLayers, ThatChangeNothingLeaveMetallicRoughness) {
  const Vec3f a = normalize(Vec3f{0.5F, 0.2F, 0.7F}), b = normalize(Vec3f{-0.3F, 0.6F, 0.4F});
  for (const float metallic : {0.0F, 0.4F, 1.0F}) {
    const Bsdf with(layered_point({0.8F, 0.5F, 0.2F}, metallic, 0.4F));
    const Bsdf without(test::flat_point({0.8F, 0.5F, 0.2F}, metallic, 0.4F));
    EXPECT_NEAR(with.eval(a, b).x, without.eval(a, b).x, 1e-5F);
    EXPECT_NEAR(with.pdf(a, b), without.pdf(a, b), 1e-5F);
  }
}

TEST(BsdfLayers, HemisphericalAlbedoIsWhatIsReflected) {
  for (const auto& [name, point] : layered_points({0.6F, 0.6F, 0.6F})) {
    if (!point.front || point.layers->clearcoat_normal.z < 1) continue;
    EXPECT_NEAR(hemispherical_albedo(point).x, mean_reflected(point, 1 << 12), 0.02) << name;
  }
}

TEST(BsdfLayers, HemisphericalAlbedoOfClearcoatsIsWhatIsReflected) {
  for (const float roughness : {0.25F, 0.5F, 1.0F}) {
    for (const float of_coat : {0.0F, 0.25F, 0.5F, 1.0F}) {
      SurfacePoint point = layered_point({0.6F, 0.6F, 0.6F}, 0, roughness);
      point.layers->clearcoat = 1;
      point.layers->clearcoat_roughness = of_coat;
      EXPECT_NEAR(hemispherical_albedo(point).x, mean_reflected(point, 1 << 15), 0.003) << roughness << ' ' << of_coat;
    }
  }
}

TEST(BsdfLayers, MirrorsShowPunctualLightsWiderAndKeepTheirEnergy) {
  SurfacePoint point = layered_point({1, 1, 1}, 1, 0);
  const Bsdf bsdf(point);
  const Vec3f viewer = normalize(Vec3f{0.5F, 0, 1});
  for (const LightSource source : {LightSource::kPunctualWidened, LightSource::kPunctualBlurred}) {
    // Around the mirrored direction, as far as the horizon on all sides.
    const Frame3f frame({-viewer.x, -viewer.y, viewer.z});
    double sum = 0;
    constexpr int kCount = 1 << 14;
    constexpr float kCosine = -0.5F;
    for (int i = 0; i < kCount; ++i) {
      Sampler sampler(5, 0, std::uint32_t(i));
      const Vec2f u = sampler.next_2d();
      // Denser towards the middle: z = cos(angle), 1 - z uniform in its logarithm.
      const float t = std::exp(std::log(1e-8F) * (1 - u.x)) * (1 - kCosine), z = 1 - t;
      const float sine = std::sqrt(std::max(0.0F, 2 * t - t * t)), phi = 2 * kPi * u.y;
      const Vec3f wi = frame.world_from_local({sine * std::cos(phi), sine * std::sin(phi), z});
      sum += double(bsdf.eval(viewer, normalize(wi), source).x) * 2 * M_PI * double(t) * std::log(1e8) / kCount;
    }
    EXPECT_NEAR(sum, 1, 0.02);
  }
}

}  // namespace
}  // namespace chiaro::renderer

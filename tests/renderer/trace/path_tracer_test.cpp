// A Lambert sphere of radius R and albedo a around a light of I cd: wherever the light stands, one bounce brings
// a I / (π R²) to every point of the wall, for cosθ cosθ' / r² = 1 / (4 R²) between any two of them. Seeds are fixed.

#include "renderer/trace/path_tracer.h"

#include <gtest/gtest.h>

#include "renderer/trace/trace_illumination.h"
#include "tests/support/code_scenes.h"

namespace chiaro::renderer {
namespace {

constexpr float kRadius = 2, kAlbedo = 0.6F, kIntensity = 10;
constexpr double kOneBounce = double(kAlbedo) * kIntensity / (M_PI * kRadius * kRadius);

Scene lambert_sphere() {
  Scene scene;
  test::add_mesh(scene, test::sphere({0, 0, 0}, kRadius, 200, true), test::lambert({kAlbedo, kAlbedo, kAlbedo}), "s");
  return scene;
}

// Middles of triangles all over the sphere that are at least `distance` from the light.
std::vector<SurfaceSample> wall_points(const Mesh& mesh, std::size_t count, Vec3f light, float distance) {
  std::vector<SurfaceSample> points;
  for (std::size_t k = 0; k < count; ++k) {
    const Triangle& t = mesh.triangles[(2 * k + 1) * mesh.triangles.size() / (2 * count)];
    const Vec3f a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
    const Vec3f middle = (a + b + c) / 3;
    if (length(middle - light) >= distance) points.push_back({middle, normalize(cross(b - a, c - a))});
  }
  return points;
}

Illumination indirect(const RayTracer& tracer, const std::vector<SurfaceSample>& points, Vec3f light, int bounces) {
  const Lights lights{PointLight{"", light, {kIntensity, kIntensity, kIntensity}}};
  Illumination all = trace_illumination(tracer, points, lights, {.samples = 1024, .bounces = bounces, .seed = 21});
  const Illumination direct = trace_illumination(tracer, points, lights, {.samples = 1, .bounces = 0});
  for (std::size_t i = 0; i < points.size(); ++i) all.value[i] = all.value[i] - direct.value[i];
  return all;
}

struct Spread {
  double mean = 0, rms_deviation = 0, rms_stated = 0;  // relative
};

Spread spread(const Illumination& result, double expected) {
  Spread s;
  const auto n = double(result.value.size());
  for (std::size_t i = 0; i < result.value.size(); ++i) {
    const double deviation = double(result.value[i].x) / expected - 1;
    const double stated = double(result.standard_error[i].x) / expected;
    s.mean += (1 + deviation) / n;
    s.rms_deviation += deviation * deviation / n;
    s.rms_stated += stated * stated / n;
  }
  s.rms_deviation = std::sqrt(s.rms_deviation), s.rms_stated = std::sqrt(s.rms_stated);
  return s;
}

TEST(PathTracer, FirstBounceInASphereIsUniformWhereverTheLightStands) {
  const Scene scene = lambert_sphere();
  const RayTracer tracer(scene);
  const Vec3f outward = normalize(Vec3f{0.36F, 0.48F, -0.8F});
  for (const float depth : {1.0F, 0.5F, 0.1F, 0.02F}) {  // of the light below the wall, in radii
    const Vec3f light = ((1 - depth) * kRadius) * outward;
    const auto points = wall_points(scene.meshes[0], 100, light, 0.25F * kRadius);
    ASSERT_GT(points.size(), 90U);
    const Spread s = spread(indirect(tracer, points, light, 1), kOneBounce);
    EXPECT_NEAR(s.mean, 1, 0.01) << depth;
    EXPECT_LT(s.rms_stated, 0.03) << depth;
    // True deviations, which errors that were stated too small would not hide; 1 % is the polyhedron's.
    EXPECT_LT(s.rms_deviation, 0.03 + 0.01) << depth;
  }
}

TEST(PathTracer, AllBouncesInASphereAreTheGeometricSeries) {
  const Scene scene = lambert_sphere();
  const RayTracer tracer(scene);
  const Vec3f light = (0.98F * kRadius) * normalize(Vec3f{0.36F, 0.48F, -0.8F});
  const auto points = wall_points(scene.meshes[0], 100, light, 0.25F * kRadius);
  const Spread s = spread(indirect(tracer, points, light, -1), kOneBounce / (1 - double(kAlbedo)));
  EXPECT_NEAR(s.mean, 1, 0.01);
  EXPECT_LT(s.rms_deviation, 0.06);
}

TEST(PathTracer, LightsOnAWallOrOnAReceiverGiveFiniteLight) {
  const Scene scene = lambert_sphere();
  const RayTracer tracer(scene);
  const auto points = wall_points(scene.meshes[0], 20, {9, 9, 9}, 0);
  const Vec3f on_vertex = scene.meshes[0].positions[3777], on_receiver = points[7].position;
  for (const Vec3f light : {on_vertex, on_receiver, offset_point(on_receiver, points[7].normal)}) {
    const Lights lights{PointLight{"", light, {kIntensity, kIntensity, kIntensity}}};
    const auto result = trace_illumination(tracer, points, lights, {.samples = 256, .seed = 5});
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_TRUE(is_finite(result.value[i])) << i;
      EXPECT_TRUE(is_finite(result.standard_error[i])) << i;
      EXPECT_GE(min_component(result.value[i]), 0) << i;
    }
  }
}

// A point light in polish, seen a little beside the mirrored direction: outside a highlight as narrow as the polish
// asks for, inside one as wide as a lamp of a centimetre makes.
TEST(PathTracer, HighlightsAreAsNarrowAsThePolishUnlessAskedToBeWide) {
  Scene scene = test::plane_scene({0, 0, 0});
  scene.materials[0] = {};
  scene.materials[0].metallic = 1;
  scene.materials[0].roughness = 0.03F;
  const RayTracer tracer(scene);
  const Lights lights{PointLight{"", {1, 1, 0}, {1, 1, 1}}};
  const Ray ray{{-1.04F, 1, 0}, normalize(Vec3f{1.04F, -1, 0})};
  const auto hit = tracer.intersect(ray);
  ASSERT_TRUE(hit);
  const SurfacePoint point = make_surface_point(scene, ray, *hit);
  const Vec3f to_light = normalize(Vec3f{1, 1, 0} - point.position);
  const float irradiance = 1 / length_squared(Vec3f{1, 1, 0} - point.position);
  float radiance[2] = {};
  for (const bool wide : {false, true}) {
    PathLight light;
    Sampler sampler(1, 0, 0);
    PathTracer(tracer, lights, {.bounces = 0, .wide_highlights = wide})
        .add_scattered(point, {}, -ray.direction, 0, {1, 1, 1}, sampler, light);
    const LightSource source = wide ? LightSource::kPunctualWidened : LightSource::kPunctual;
    const float expected = Bsdf(point).eval(-ray.direction, to_light, source).x * irradiance;
    EXPECT_NEAR(light.direct.x, expected, 1e-4F * expected) << wide;
    radiance[wide ? 1 : 0] = light.direct.x;
  }
  EXPECT_LT(radiance[0], 0.1F * radiance[1]);
}

TEST(PathTracer, LightIsTakenApartByItsSource) {
  Scene scene = test::corner_with_ball();
  test::add_mesh(scene, test::rectangle({1, 2.5F, 1}, {1, 0, 0}, {0, 0, 1}), test::lambert({0, 0, 0}, {5, 5, 5}),
                 "lamp");
  const RayTracer tracer(scene);
  const Lights lights{PointLight{"", {3, 2, 3}, {10, 8, 6}},
                      SpotLight{"", {1, 2, 3}, {0, -1, 0}, {9, 9, 9}, 0.3F, 0.7F}};
  const PathTracer paths(tracer, lights, {});
  PathLight light;
  light.per_light.assign(3, Vec3f{});
  for (std::uint32_t k = 0; k < 2000; ++k) {
    Sampler sampler(8, 0, k);
    paths.add_illumination({{2, 1e-5F, 3}, {0, 1, 0}}, true, sampler, light);
  }
  const Vec3f sum = light.per_light[0] + light.per_light[1] + light.per_light[2], all = light.direct + light.indirect;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], all[c], 1e-4F * all[c]);
  for (const Vec3f part : light.per_light) EXPECT_GT(min_component(part), 0);
  EXPECT_TRUE(paths.has_emission());
  EXPECT_EQ(paths.emission_source(), 2U);
}

}  // namespace
}  // namespace chiaro::renderer

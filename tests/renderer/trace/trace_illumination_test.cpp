// Closed forms of light transport. Where a value is statistical, the bound is stated in standard errors and the seed is
// fixed.

#include "renderer/trace/trace_illumination.h"

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"
#include "renderer/image/mip_maps.h"
#include "tests/support/code_scenes.h"

namespace chiaro::renderer {
namespace {

using test::add_mesh;
using test::lambert;
using test::plane_scene;
using test::rectangle;

TEST(TraceIllumination, PointLightOverPlaneIsIntensityCosineOverPiDistanceSquared) {
  const Scene scene = plane_scene({0.5F, 0.5F, 0.5F});
  const RayTracer tracer(scene);
  const Lights lights{PointLight{"", {0.3F, 2, -0.4F}, {10, 20, 5}}};
  std::vector<SurfaceSample> points;
  for (const Vec3f& p : scene.meshes[0].positions) points.push_back({p, {0, 1, 0}});
  const Illumination result = trace_illumination(tracer, points, lights, {.samples = 4, .bounces = 0});
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3f d = Vec3f{0.3F, 2, -0.4F} - points[i].position;
    const double expected = 10 * 2.0 / (double(kPi) * std::pow(double(length(d)), 3));
    EXPECT_NEAR(result.value[i].x, expected, 1e-5 * expected);
    EXPECT_NEAR(result.value[i].y, 2 * expected, 2e-5 * expected);
    EXPECT_EQ(result.standard_error[i].x, 0);
  }
}

// What a quad sends to a wall that faces it, for each texel white, and for a white island in a black atlas: filters
// know nothing of the island's border, so that scattered rays look textures up as they are.
TEST(TraceIllumination, AnIslandOfAnAtlasIsAsBrightAsAPlainSurface) {
  constexpr int kAtlas = 256, kIsland = 64;
  Texture atlas{"", kAtlas, kAtlas, std::vector<std::uint8_t>(std::size_t(4 * kAtlas * kAtlas), 0)};
  for (int y = 0; y < kAtlas; ++y) {
    for (int x = 0; x < kAtlas; ++x) {
      for (int c = 0; c < 4; ++c) {
        const bool inside = x < kIsland + 8 && y < kIsland + 8;
        atlas.rgba[std::size_t(4 * (kAtlas * y + x) + c)] = inside || c == 3 ? 255 : 0;
      }
    }
  }
  const auto lit = [&](bool textured) {
    Scene scene;
    Mesh quad = rectangle({-0.1F, 0, 0.1F}, {0.2F, 0, 0}, {0, 0, -0.2F});
    for (const Vec3f p : quad.positions) {
      quad.uv[0].push_back(
          {(4 + kIsland * (p.x + 0.1F) / 0.2F) / kAtlas, (4 + kIsland * (p.z + 0.1F) / 0.2F) / kAtlas});
    }
    Material material = lambert({1, 1, 1});
    if (textured) material.base_color_texture.texture = 0;
    add_mesh(scene, quad, material, "quad");
    scene.textures.push_back(atlas);
    make_mip_maps(scene.textures[0], {.srgb = true});
    const RayTracer tracer(scene);
    const std::vector<SurfaceSample> wall{{{0, 2, 0}, {0, -1, 0}}};
    return trace_illumination(tracer, wall, {PointLight{"", {2, 2, 0}, {100, 100, 100}}},
                              {.samples = 1 << 14, .bounces = 1})
        .value[0]
        .x;
  };
  EXPECT_NEAR(lit(true) / lit(false), 1, 1e-3F);
}

// A small panel seen at an angle, polished or not: light samples and scattered rays find the same.
TEST(TraceIllumination, PolishedLampsGiveWhatTheirCoatLetsOut) {
  const auto lit = [](float clearcoat, Vec3f at) {
    Scene scene;
    Material material = lambert({0, 0, 0}, {1, 1, 1});
    material.lambert = false;
    material.layers.emplace();
    material.layers->clearcoat = clearcoat;
    add_mesh(scene, rectangle({-0.05F, 0, -0.05F}, {0, 0, 0.1F}, {0.1F, 0, 0}), material, "panel");
    const RayTracer tracer(scene);
    return trace_illumination(tracer, std::vector<SurfaceSample>{{at, normalize(-at)}}, {},
                              {.samples = 1 << 14, .bounces = 0})
        .value[0]
        .x;
  };
  for (const float angle : {0.1F, 1.0F, 1.4F}) {
    const Vec3f at{3 * std::sin(angle), 3 * std::cos(angle), 0};
    const float left = 1 - (0.04F + 0.96F * std::pow(1 - std::cos(angle), 5.0F));
    EXPECT_NEAR(lit(1, at) / lit(0, at), left, 0.02F) << angle;
  }
}

TEST(TraceIllumination, SpotAndDirectionalLightsFollowTheirDefinitions) {
  const Scene scene = plane_scene({0.5F, 0.5F, 0.5F});
  const RayTracer tracer(scene);
  const std::vector<SurfaceSample> points{{{0, 0, 0}, {0, 1, 0}}, {{1.5F, 0, 0}, {0, 1, 0}}};
  const Lights spot{SpotLight{"", {0, 2, 0}, {0, -1, 0}, {8, 8, 8}, 0.1F, 0.5F}};
  const auto by_spot = trace_illumination(tracer, points, spot, {.samples = 1, .bounces = 0});
  EXPECT_NEAR(by_spot.value[0].x, 8 / (4 * kPi), 1e-6);
  EXPECT_EQ(by_spot.value[1].x, 0);  // 36.9 degrees from the axis, outside the cone of 28.6
  const Lights sun{DirectionalLight{"", normalize(Vec3f{0, -1, 1}), {100, 100, 100}}};
  const auto by_sun = trace_illumination(tracer, points, sun, {.samples = 1, .bounces = 0});
  EXPECT_NEAR(by_sun.value[0].x, 100 * std::sqrt(0.5F) / kPi, 1e-4);
}

TEST(TraceIllumination, ByLightIsTheSameTakenApart) {
  Scene scene;
  add_mesh(scene, test::room({4, 3, 4}), lambert({0.5F, 0.6F, 0.7F}), "room");
  const RayTracer tracer(scene);
  const Lights lights{PointLight{"", {1, 2, 1}, {10, 0, 0}}, PointLight{"", {3, 1, 2}, {0, 20, 5}}};
  const std::vector<SurfaceSample> points{{{2, 0.001F, 2}, {0, 1, 0}}, {{0.001F, 1, 3}, {1, 0, 0}}};
  for (const int bounces : {0, 3}) {
    const TraceOptions options{.samples = 30, .bounces = bounces, .seed = 5};
    const auto whole = trace_illumination(tracer, points, lights, options);
    const IlluminationByLight by_light = trace_illumination_by_light(tracer, points, lights, options);
    const auto& parts = by_light.of_light;
    EXPECT_EQ(by_light.total.value, whole.value);
    EXPECT_EQ(by_light.total.standard_error, whole.standard_error);
    ASSERT_EQ(parts.size(), 2U);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_GT(parts[0][i].x, 0);
      EXPECT_NEAR(parts[0][i].x, whole.value[i].x, 1e-5F * whole.value[i].x);
      EXPECT_EQ(parts[0][i].y, 0);
      EXPECT_NEAR(parts[1][i].z, whole.value[i].z, 1e-5F * whole.value[i].z);
    }
  }
}

TEST(TraceIllumination, NoiseIsToldHoweverBrightOrDim) {
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  const std::vector<SurfaceSample> points{{{2, 0.001F, 2}, {0, 1, 0}}, {{0.001F, 1, 3}, {1, 0, 0}}};
  const auto noise_of = [&](float candela) {
    const Lights lights{PointLight{"", {3, 2, 3}, {candela, candela, candela}}};
    return relative_standard_error(trace_illumination(tracer, points, lights, {.samples = 8, .bounces = 2})).value();
  };
  const double expected = noise_of(1);
  ASSERT_GT(expected, 0.001);
  for (const float candela : {1e-24F, 1e20F, 1e24F}) EXPECT_NEAR(noise_of(candela), expected, 1e-3 * expected);
}

TEST(TraceIllumination, OnePathDoesNotTellItsErrorButAnotherTraceDoes) {
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  const Lights lights{PointLight{"", {3, 2, 3}, {10, 10, 10}}};
  const std::vector<SurfaceSample> points(100, {{2, 0.001F, 2}, {0, 1, 0}});
  const auto traced = [&](int samples, std::uint64_t seed) {
    return trace_illumination(tracer, points, lights, {.samples = samples, .bounces = 2, .seed = seed});
  };
  const Illumination one = traced(1, 1), many = traced(16, 2);
  EXPECT_TRUE(one.standard_error.empty());
  EXPECT_FALSE(relative_standard_error(one));
  EXPECT_FALSE(relative_standard_error(joined(one, 1, one, 1)));
  const double of_many = relative_standard_error(many).value(), expected = of_many * std::sqrt(16.0 / 17);
  EXPECT_NEAR(relative_standard_error(joined(one, 1, many, 16)).value(), expected, 0.01 * expected);
  EXPECT_NEAR(relative_standard_error(joined(many, 16, one, 1)).value(), expected, 0.01 * expected);
  // Direct light alone is exact.
  const auto direct = trace_illumination(tracer, points, lights, {.samples = 1, .bounces = 0});
  EXPECT_EQ(relative_standard_error(direct), 0);
}

TEST(TraceIllumination, FurnaceGivesEmissionOverOneMinusAlbedo) {
  // Inside a closed surface of emission e and albedo a, radiance and illumination are e / (1 - a) everywhere.
  for (const float albedo : {0.0F, 0.5F, 0.8F}) {
    Scene scene;
    add_mesh(scene, test::sphere({0, 0, 0}, 2, 32, true), lambert({albedo, albedo, albedo}, {1, 1, 1}), "furnace");
    const RayTracer tracer(scene);
    const std::vector<SurfaceSample> points{{{0.3F, 0.2F, 0.1F}, {0, 1, 0}},
                                            {{-1, 0.4F, 0.6F}, normalize(Vec3f{1, 1, 0})}};
    const auto result = trace_illumination(tracer, points, {}, {.samples = 4096, .seed = 3});
    for (std::size_t i = 0; i < points.size(); ++i) {
      // Six standard errors of 3 degrees of freedom, p < 1 %; and half a percent for roulette's rare long paths.
      const double bound = 6 * double(result.standard_error[i].x) + 0.005 / (1 - double(albedo));
      EXPECT_NEAR(result.value[i].x, 1 / (1 - albedo), bound) << "albedo " << albedo;
    }
  }
}

TEST(TraceIllumination, SphereAroundALightIsUniform) {
  // At radius r around a light of I cd: direct I / (π r²); each bounce multiplies the mean by the albedo.
  const float radius = 2, albedo = 0.6F;
  Scene scene;
  add_mesh(scene, test::sphere({0, 0, 0}, radius, 64, true), lambert({albedo, albedo, albedo}), "sphere");
  const RayTracer tracer(scene);
  const Lights lights{PointLight{"", {0, 0, 0}, {10, 10, 10}}};
  const Vec3f n = normalize(Vec3f{0.3F, 0.5F, -0.7F});
  const std::vector<SurfaceSample> points{{(-0.998F * radius) * n, n}};
  const double direct = 10 / (double(kPi) * radius * radius);
  double expected = 0;
  for (int bounces = 0; bounces <= 4; ++bounces) {
    expected += direct * std::pow(double(albedo), bounces);
    const auto result = trace_illumination(tracer, points, lights, {.samples = 2048, .bounces = bounces, .seed = 11});
    EXPECT_NEAR(result.value[0].x, expected, 6 * double(result.standard_error[0].x) + 0.006 * expected) << bounces;
  }
}

TEST(TraceIllumination, ClosedBoxConservesEnergy) {
  // Light that a diffuse box absorbs equals what its lamp emits: (1 - a) ∫ E dA = 4 π I.
  const float albedo = 0.5F;
  Scene scene;
  add_mesh(scene, test::room({3, 2, 4}, 8), lambert({albedo, albedo, albedo}), "room");
  const RayTracer tracer(scene);
  const Lights lights{PointLight{"", {1.2F, 1.1F, 1.7F}, {5, 5, 5}}};
  const Mesh& mesh = scene.meshes[0];
  std::vector<SurfaceSample> points;
  std::vector<double> areas;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3f e1 = mesh.positions[b] - mesh.positions[a], e2 = mesh.positions[c] - mesh.positions[a];
    for (std::uint32_t k = 0; k < 16; ++k) {  // stratified points per triangle
      Sampler sampler(1, t, k);
      Vec2f u = sampler.next_2d();
      if (u.x + u.y > 1) u = {1 - u.x, 1 - u.y};
      points.push_back({mesh.positions[a] + u.x * e1 + u.y * e2, mesh.normals[a]});
      areas.push_back(0.5 * double(length(cross(e1, e2))) / 16);
    }
  }
  const auto result = trace_illumination(tracer, points, lights, {.samples = 16, .seed = 5});
  double absorbed = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    absorbed += (1 - double(albedo)) * double(kPi * result.value[i].x) * areas[i];
  EXPECT_NEAR(absorbed / (4 * double(kPi) * 5), 1, 0.01);
}

TEST(TraceIllumination, EmissivePanelMatchesItsFormFactor) {
  // A unit square emitter straight above a point, parallel, at distance h: Lambert's formula for a centred square.
  Scene scene;
  add_mesh(scene, rectangle({-0.5F, 1, -0.5F}, {1, 0, 0}, {0, 0, 1}), lambert({0, 0, 0}, {3, 2, 1}), "panel");
  const RayTracer tracer(scene);
  const std::vector<SurfaceSample> points{{{0, 0, 0}, {0, 1, 0}}};
  const double a = 0.5;  // half side over distance
  const double form_factor =
      4 * (2 / (2 * double(kPi))) * (a / std::sqrt(1 + a * a)) * std::atan(a / std::sqrt(1 + a * a));
  const auto result = trace_illumination(tracer, points, {}, {.samples = 4096, .bounces = 0, .seed = 2});
  EXPECT_NEAR(result.value[0].x, 3 * form_factor, 6 * double(result.standard_error[0].x) + 1e-4);
  EXPECT_NEAR(result.value[0].z, 1 * form_factor, 6 * double(result.standard_error[0].z) + 1e-4);
}

// A lamp in a small box, far above, and a panel with a cover right below it.
TEST(TraceIllumination, WhatIsCloseToALampHidesItFromAfar) {
  Scene scene;
  const float size = 0.006F, height = 50;
  Mesh box = test::room({size, size, size});
  for (Vec3f& p : box.positions) p = p + Vec3f{-size / 2, height - size / 2, -size / 2};
  add_mesh(scene, box, lambert({0.5F, 0.5F, 0.5F}), "box");
  add_mesh(scene, rectangle({99.5F, 40, -0.5F}, {1, 0, 0}, {0, 0, 1}), lambert({0, 0, 0}, {3, 2, 1}), "panel");
  add_mesh(scene, rectangle({99, 39.997F, -1}, {2, 0, 0}, {0, 0, 2}), lambert({0, 0, 0}), "cover");
  const RayTracer tracer(scene);
  const std::vector<SurfaceSample> points{{{0, 0, 0}, {0, 1, 0}}, {{50, 0, 0}, {0, 1, 0}}, {{100, 0, 0}, {0, 1, 0}}};
  const Lights lamp{PointLight{"", {0, height, 0}, {1e4F, 1e4F, 1e4F}}};
  for (const Vec3f value : trace_illumination(tracer, points, lamp, {.samples = 64, .bounces = 0, .seed = 2}).value) {
    EXPECT_EQ(value, Vec3f{});
  }
}

// What alpha hides of a surface gives no light either, however it is found: by rays or by light samples.
TEST(TraceIllumination, EmissiveSurfacesShineAsFarAsAlphaHoldsThem) {
  const auto traced = [](AlphaMode mode, float alpha) {
    Scene scene;
    Material panel = lambert({0, 0, 0}, {3, 2, 1});
    panel.alpha_mode = mode;
    panel.alpha = alpha;
    add_mesh(scene, rectangle({-0.5F, 1, -0.5F}, {1, 0, 0}, {0, 0, 1}), panel, "panel");
    const RayTracer tracer(scene);
    const std::vector<SurfaceSample> points{{{0, 0, 0}, {0, 1, 0}}};
    return trace_illumination(tracer, points, {}, {.samples = 8192, .bounces = 0, .seed = 2});
  };
  const auto whole = traced(AlphaMode::kOpaque, 1).value[0].x;
  for (const float alpha : {1.0F, 0.6F, 0.1F, 0.0F}) {
    const auto blended = traced(AlphaMode::kBlend, alpha);
    EXPECT_NEAR(blended.value[0].x, alpha * whole, 6 * blended.standard_error[0].x + 1e-4F) << alpha;
    EXPECT_NEAR(traced(AlphaMode::kMask, alpha).value[0].x, alpha >= 0.5F ? whole : 0, 0.01F * whole) << alpha;
  }
}

// A mirror above a lamp throws the light of the lamp's image, although no path meets the lamp itself.
TEST(TraceIllumination, MirrorsThrowTheLightOfTheImage) {
  Scene scene;
  Material mirror;
  mirror.roughness = 0;
  add_mesh(scene, rectangle({-20, 3, -20}, {40, 0, 0}, {0, 0, 40}), mirror, "mirror");
  const RayTracer tracer(scene);
  std::vector<SurfaceSample> points;
  for (int k = 0; k < 20; ++k) points.push_back({{0.1F * float(k) - 1, 0, 0.3F}, {0, 1, 0}});
  const Lights lamp{PointLight{"", {0.5F, 2, 0}, {10, 10, 10}}};
  const Vec3f image{0.5F, 4, 0};
  const auto all = trace_illumination(tracer, points, lamp, {.samples = 20000, .bounces = 1, .seed = 3});
  const auto direct = trace_illumination(tracer, points, lamp, {.samples = 1, .bounces = 0});
  double found = 0, expected = 0, variance = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3f way = image - points[i].position;
    expected += 10 * double(way.y) / (double(kPi) * std::pow(double(length(way)), 3));
    found += double(all.value[i].x - direct.value[i].x);
    variance += std::pow(double(all.standard_error[i].x), 2);
  }
  EXPECT_LT(std::sqrt(variance), 0.005 * expected);
  EXPECT_NEAR(found, expected, 4 * std::sqrt(variance) + 0.03 * expected);  // a lobe of some width looks past the image
}

TEST(TraceIllumination, ErrorShrinksAndCoversTheTruth) {
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  const Lights lights{PointLight{"", {3, 2, 3}, {10, 10, 10}}};
  std::vector<SurfaceSample> points;
  for (int i = 0; i < 100; ++i) points.push_back({{0.1F + 0.038F * float(i), 0, 3}, {0, 1, 0}});
  const auto reference = trace_illumination(tracer, points, lights, {.samples = 8192, .seed = 100});
  const auto coarse = trace_illumination(tracer, points, lights, {.samples = 64, .seed = 200});
  double chi_squared = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double z =
        double(coarse.value[i].x - reference.value[i].x) / std::max(1e-9, double(coarse.standard_error[i].x));
    chi_squared += std::min(z * z, 25.0);
  }
  // z follows Student's t of 3 degrees of freedom, cut at 5: E z² = 2.1. Far from 100 × 2.1 only if the stated errors
  // are wrong.
  EXPECT_GT(chi_squared, 80);
  EXPECT_LT(chi_squared, 450);
}

TEST(TraceIllumination, SameBytesForAnyNumberOfThreads) {
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  const Lights lights{PointLight{"", {3, 2, 3}, {10, 10, 10}}};
  std::vector<SurfaceSample> points;
  for (int i = 0; i < 500; ++i) points.push_back({{0.1F + 0.0075F * float(i), 0, 3}, {0, 1, 0}});
  std::vector<Illumination> results;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    results.push_back(trace_illumination(tracer, points, lights, {.samples = 16, .seed = 1}));
  }
  EXPECT_EQ(results[0].value, results[1].value);
}

}  // namespace
}  // namespace chiaro::renderer

// Light through glass, against closed forms. Seeds are fixed.

#include "renderer/trace/clear_surfaces.h"

#include <gtest/gtest.h>

#include "renderer/trace/fresnel.h"
#include "renderer/trace/path_tracer.h"
#include "renderer/trace/render.h"
#include "tests/support/code_scenes.h"
#include "tests/support/environments.h"

namespace chiaro::renderer {
namespace {

using test::add_mesh;
using test::rectangle;

Material glass(bool solid, float roughness = 0, Vec3f absorption = {}) {
  Material material;
  material.metallic = 0;
  material.roughness = roughness;
  material.layers.emplace();
  material.layers->transmission = 1;
  material.layers->solid = solid;
  material.layers->absorption = absorption;
  return material;
}

Mesh outwards(Mesh mesh) {
  for (Vec3f& normal : mesh.normals) normal = -normal;
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

// A block of glass over y = 1 … 1 + thickness.
Mesh block(float thickness) {
  Mesh mesh = outwards(test::room({20, thickness, 20}));
  for (Vec3f& p : mesh.positions) p = p + Vec3f{-10, 1, -10};
  return mesh;
}

Mesh pane() { return rectangle({-10, 1, -10}, {0, 0, 20}, {20, 0, 0}); }

Vec3f traced(const Scene& scene, const Lights& lights, int bounces = 0, int samples = 64) {
  const RayTracer tracer(scene);
  const SurfaceSample floor{{0.3F, 0, 0.2F}, {0, 1, 0}};
  return trace_illumination(tracer, {&floor, 1}, lights, {.samples = samples, .bounces = bounces, .seed = 4}).value[0];
}

const Lights kAbove{PointLight{"", {0.3F, 3, 0.2F}, {90, 90, 90}}};
constexpr double kUnhindered = 90.0 / 9.0 / M_PI;
constexpr double kThrough = 0.96;  // of one boundary of refractive index 1.5

TEST(ClearSurfaces, ALampBehindAWindowPaneLightsTheRoom) {
  for (const float roughness : {0.0F, 0.1F}) {
    Scene scene;
    add_mesh(scene, pane(), glass(false, roughness), "pane");
    EXPECT_NEAR(traced(scene, kAbove).x, kUnhindered * kThrough, 1e-3);
    scene.materials[0].base_color = {0.5F, 1, 1};
    EXPECT_NEAR(traced(scene, kAbove).x, kUnhindered * kThrough * 0.5, 1e-3);
  }
}

TEST(ClearSurfaces, ABlockOfGlassReflectsTwiceAndAbsorbsByItsThickness) {
  Scene scene;
  add_mesh(scene, block(0.5F), glass(true, 0, {0, 2, 6}), "block");
  const Vec3f light = traced(scene, kAbove);
  EXPECT_NEAR(light.x, kUnhindered * kThrough * kThrough, 1e-3);
  EXPECT_NEAR(light.y, double(light.x) * std::exp(-1.0), 1e-3);
  EXPECT_NEAR(light.z, double(light.x) * std::exp(-3.0), 1e-3);
}

TEST(ClearSurfaces, ALampInsideABlockShinesOut) {
  Scene scene;
  add_mesh(scene, block(0.5F), glass(true, 0, {0, 2, 0}), "block");
  const Lights inside{PointLight{"", {0.3F, 1.25F, 0.2F}, {9, 9, 9}}};
  const Vec3f light = traced(scene, inside);
  EXPECT_NEAR(light.x, 9 / (1.25 * 1.25) / M_PI * kThrough, 1e-3);
  EXPECT_NEAR(light.y, double(light.x) * std::exp(-0.5), 1e-3);
}

TEST(ClearSurfaces, OpaqueAndFrostedSurfacesThrowShadows) {
  Scene scene;
  add_mesh(scene, pane(), glass(false, 0.5F), "frosted");
  EXPECT_EQ(traced(scene, kAbove).x, 0);
  scene.materials[0] = glass(false);
  scene.materials[0].metallic = 1;
  EXPECT_EQ(traced(scene, kAbove).x, 0);
}

// An emitting ceiling seen by light samples and by scattered rays: the two agree with the whole behind a pane, so does
// a floor between whose rays none is lost or counted twice.
TEST(ClearSurfaces, EmissiveSurfacesShineThroughAPane) {
  const auto ceiling = [](bool with_pane) {
    Scene scene;
    if (with_pane) add_mesh(scene, pane(), glass(false), "pane");
    add_mesh(scene, rectangle({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), test::lambert({0, 0, 0}, {50, 50, 50}), "lamp");
    return traced(scene, {}, 0, 1 << 14).x;
  };
  const double open = double(ceiling(false)), behind = double(ceiling(true));
  // Between Fresnel's shares of straight and of 45° rays.
  EXPECT_LT(behind, open * 0.962);
  EXPECT_GT(behind, open * 0.94);
}

// Of a solid that does not bend light rays go straight through, so light samples have to as well.
TEST(ClearSurfaces, SolidsThatDoNotBendLightOnlyAbsorb) {
  const auto below = [](float ior, bool with_block) {
    Scene scene;
    if (with_block) add_mesh(scene, block(0.5F), glass(true, 0, {0, 2, 0}), "block");
    if (with_block) scene.materials[0].layers->ior = ior;
    add_mesh(scene, rectangle({-0.02F, 9, -0.02F}, {0.04F, 0, 0}, {0, 0, 0.04F}),
             test::lambert({0, 0, 0}, {9e4F, 9e4F, 0}), "lamp");
    add_mesh(scene, rectangle({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), test::lambert({0, 0, 0}, {0, 0, 50}), "ceiling");
    scene.materials.back().alpha_mode = AlphaMode::kBlend;
    scene.materials.back().alpha = 0.5F;
    return traced(scene, {}, 0, 1 << 14);
  };
  const Vec3f open = below(1, false);
  for (const float ior : {1.0F, 1.01F}) {
    const Vec3f behind = below(ior, true);
    EXPECT_NEAR(behind.x / open.x, 1, 0.02) << ior;
    EXPECT_NEAR(behind.y / open.y, std::exp(-1.0), 0.02) << ior;
    EXPECT_NEAR(behind.z / open.z, 1, 0.02) << ior;
  }
}

double frame_mean(const Scene& scene, Vec3f eye, int samples, const Lights& lights = {}) {
  const RayTracer tracer(scene);
  Camera camera;
  camera.vertical_fov = 0.05F;
  for (int row = 0; row < 3; ++row) camera.world_from_camera(row, 3) = eye[row];
  RenderOptions options{.width = 8, .height = 8, .box_filter = true, .layers = {}};
  options.trace.samples = samples;
  options.trace.seed = 9;
  const Frame frame = render(tracer, camera, lights, options);
  double sum = 0;
  for (int i = 0; i < 64; ++i)
    sum += double(frame.image.pixels[std::size_t(i) * std::size_t(frame.image.channel_names.size())]) / 64;
  return sum;
}

// In a room that glows the same everywhere, glass that absorbs nothing cannot be seen.
TEST(ClearSurfaces, GlassIsInvisibleInAFurnace) {
  for (const float roughness : {0.0F, 0.3F, 0.6F, 1.0F}) {
    for (const bool solid : {false, true}) {
      Scene scene;
      add_mesh(scene, test::sphere({0, 0, 0}, 1, 24), glass(solid, roughness), "ball");
      add_mesh(scene, test::sphere({0, 0, 0}, 9, 24, true), test::lambert({0, 0, 0}, {1, 1, 1}), "sky");
      EXPECT_NEAR(frame_mean(scene, {0, 0, 4}, 256), 1, roughness > 0 ? 0.04 : 0.015) << solid << ' ' << roughness;
    }
  }
}

// Nor are white solids that let a part of the light in: what meets the other part from inside stays in there.
TEST(ClearSurfaces, PartlyTransmissiveSolidsLoseNothing) {
  for (const float transmission : {0.5F, 0.9F}) {
    Scene scene;
    Material material = glass(true, 0);
    material.layers->transmission = transmission;
    add_mesh(scene, test::sphere({0, 0, 0}, 1, 24), material, "ball");
    add_mesh(scene, test::sphere({0, 0, 0}, 9, 24, true), test::lambert({0, 0, 0}, {1, 1, 1}), "sky");
    EXPECT_NEAR(frame_mean(scene, {0, 0, 4}, 4096), 1, 0.02) << transmission;
  }
}

// Through the middle of an absorbing ball, seen from afar: (1 − R)² e^(−2 a r) / (1 − R² e^(−4 a r)) of what is behind,
// and R (1 + …) of what is in front, of which both glow alike.
TEST(ClearSurfaces, AnAbsorbingBallIsAsDarkAsItsDiameterMakesIt) {
  const double a = 0.7, r = 1, through = std::exp(-2 * a * r), reflected = 0.04;
  Scene scene;
  add_mesh(scene, test::sphere({0, 0, 0}, float(r), 48), glass(true, 0, {0.7F, 0, 0}), "ball");
  add_mesh(scene, test::sphere({0, 0, 0}, 9, 24, true), test::lambert({0, 0, 0}, {1, 1, 1}), "sky");
  const double passed = (1 - reflected) * (1 - reflected) * through / (1 - reflected * through);
  EXPECT_NEAR(frame_mean(scene, {0, 0, 4}, 256), reflected + passed, 0.01);
}

// Deep water without a ground: of the sky its surface shows the reflection alone, smooth or not, however it is sampled.
TEST(ClearSurfaces, NothingComesBackOutOfWaterWithoutAGround) {
  const Lights sky{test::environment(test::environment_map(2, 1, [](int, int) { return Vec3f{1, 1, 1}; }))};
  for (const float roughness : {0.0F, 0.2F}) {
    Scene scene;
    add_mesh(scene, rectangle({-10, -10, 0}, {20, 0, 0}, {0, 20, 0}), glass(true, roughness, {0.7F, 0, 0}), "water");
    EXPECT_NEAR(frame_mean(scene, {0, 0, 4}, 1024, sky), 0.04, 0.002) << roughness;
  }
}

// What absorbs is the way inside, on whichever side of the frosted boundary a light is.
TEST(ClearSurfaces, FrostedSolidsAbsorbInsideAlone) {
  const float a = 0.7F, r = 0.01F;
  Scene scene;
  add_mesh(scene, test::sphere({0, 0, 0}, r, 48), glass(true, 0.5F), "ball");
  const Lights lights[] = {{PointLight{"", {0, 0, -3}, {90, 90, 90}}},
                           {DirectionalLight{"", {0, 0, 1}, {9, 9, 9}}},
                           {PointLight{"", {0, 0, 3}, {90, 90, 90}}}};
  for (const Lights& light : lights) {
    scene.materials[0].layers->absorption = {};
    const double without = frame_mean(scene, {0, 0, 0.3F}, 64, light);
    scene.materials[0].layers->absorption = {a, 0, 0};
    EXPECT_GT(without, 1e-3);
    const double ratio = frame_mean(scene, {0, 0, 0.3F}, 64, light) / without;
    EXPECT_LT(ratio, 1);
    EXPECT_GT(ratio, std::exp(-6 * a * r)) << "reflected within a few times at most";
  }
}

TEST(ClearSurfaces, FrostedSolidsAbsorbWhatALampInsideThemSends) {
  const float a = 3.5F, way = 0.9F;
  Scene scene;
  add_mesh(scene, test::sphere({0, 0, 0}, 1, 48), glass(true, 0.6F), "ball");
  add_mesh(scene, test::sphere({0, 0, 0}, 1 - way, 24), test::lambert({0, 0, 0}, {9, 9, 9}), "lamp");
  const double without = frame_mean(scene, {0, 0, 5}, 256);
  scene.materials[0].layers->absorption = {a, 0, 0};
  const double ratio = frame_mean(scene, {0, 0, 5}, 256) / without;
  EXPECT_LT(ratio, std::exp(-a * way) * 1.01);
  EXPECT_GT(ratio, std::exp(-a * way) * 0.8);
}

// A camera, a receiver and a lamp inside.
TEST(ClearSurfaces, WhatIsInsideASolidIsSeenThroughIt) {
  const float a = 0.7F;
  Scene scene;
  add_mesh(scene, test::sphere({0, 0, 0}, 1, 96), glass(true, 0, {a, 0, 0}), "ball");
  scene.materials[0].layers->ior = 1;
  add_mesh(scene, test::sphere({0, 0, 0}, 9, 24, true), test::lambert({0, 0, 0}, {1, 1, 1}), "sky");
  EXPECT_NEAR(frame_mean(scene, {0, 0, 0}, 16), std::exp(-a), 2e-3);
  EXPECT_NEAR(frame_mean(scene, {0, 0, 0.5F}, 16), std::exp(-1.5F * a), 2e-3);
  add_mesh(scene, test::sphere({0, 0, -0.5F}, 0.2F, 48), test::lambert({0, 0, 0}, {2, 2, 2}), "lamp");
  EXPECT_NEAR(frame_mean(scene, {0, 0, 0}, 16), 2 * std::exp(-0.3F * a), 2e-3);

  Scene lake;
  add_mesh(lake, block(0.5F), glass(true, 0, {2, 0, 0}), "block");
  const RayTracer tracer(lake);
  const SurfaceSample ground{{0, 1.1F, 0}, {0, 1, 0}};
  const Lights lamp{PointLight{"", {0, 1.4F, 0}, {1, 1, 1}}};
  const Vec3f light = trace_illumination(tracer, {&ground, 1}, lamp, {.samples = 4, .bounces = 0, .seed = 4}).value[0];
  EXPECT_NEAR(light.x / light.y, std::exp(-0.3 * 2), 1e-4);
}

TEST(ClearSurfaces, MediaAreToldByWhatRaysLeave) {
  Scene scene;
  add_mesh(scene, test::sphere({0, 0, 0}, 2, 24), glass(true, 0, {1, 1, 1}), "outer");
  add_mesh(scene, test::sphere({0, 0, 0}, 1, 24), glass(true, 0, {2, 2, 2}), "inner");
  add_mesh(scene, rectangle({-5, -9, -5}, {0, 0, 10}, {10, 0, 0}), glass(true, 0, {3, 3, 3}), "lake");
  const RayTracer tracer(scene);
  const auto absorption = [&](Vec3f at) { return -std::log(Media::at(tracer, at).transmittance(1).x); };
  EXPECT_NEAR(absorption({0, 0, 0}), 2, 1e-5);
  EXPECT_NEAR(absorption({0, 1.5F, 0}), 1, 1e-5);
  EXPECT_TRUE(Media::at(tracer, {0, 3, 0}).empty());
  EXPECT_NEAR(absorption({0, -9.5F, 0}), 3, 1e-5) << "below an open surface";
  EXPECT_TRUE(Media::at(tracer, {0, -8.5F, 0}).empty());
}

// Lights are chosen from, where there are many, on both sides of what lets light through.
TEST(ClearSurfaces, ManyLampsBehindFrostedGlassShineAsOneDoes) {
  Scene scene;
  add_mesh(scene, rectangle({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}), glass(false, 0.6F), "frosted");
  const Lights one{PointLight{"", {0.5F, 0, -2}, {40, 40, 40}}};
  const Lights many(20, PointLight{"", {0.5F, 0, -2}, {2, 2, 2}});
  const double expected = frame_mean(scene, {0, 0, 4}, 16, one);
  EXPECT_GT(expected, 0.1);
  EXPECT_NEAR(frame_mean(scene, {0, 0, 4}, 16, many), expected, 0.02 * expected);
}

TEST(ClearSurfaces, UnlitSurfacesAreSeenAndCastNoShadow) {
  Scene scene;
  add_mesh(scene, rectangle({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}), test::lambert({0.25F, 0.5F, 1}), "picture");
  scene.materials[0].unlit = true;
  EXPECT_NEAR(frame_mean(scene, {0, 0, 4}, 4), 0.25, 1e-4);
  scene.instances[0].world_from_object =
      make_transform({0, 1, 0}, {-std::sqrt(0.5F), 0, 0, std::sqrt(0.5F)}, {1, 1, 1});
  EXPECT_NEAR(traced(scene, kAbove).x, kUnhindered, 1e-3);
}

TEST(ClearSurfaces, MediaNestAndAreLeftInAnyOrder) {
  const auto surface = [](int material, bool front, float absorption) {
    SurfacePoint point;
    point.material = material;
    point.front = front;
    point.layers.emplace();
    point.layers->solid = true;
    point.layers->absorption = {absorption, absorption, absorption};
    return point;
  };
  Media media;
  EXPECT_EQ(media.transmittance(5).x, 1);
  media.cross(surface(1, true, 1));
  media.cross(surface(2, true, 2));
  EXPECT_FLOAT_EQ(media.transmittance(1).x, std::exp(-2.0F));
  media.cross(surface(1, false, 1));
  EXPECT_FLOAT_EQ(media.transmittance(1).x, std::exp(-2.0F));
  media.cross(surface(2, false, 2));
  EXPECT_TRUE(media.empty());
  EXPECT_FLOAT_EQ(media.transmittance(surface(3, false, 3), 1).x, std::exp(-3.0F)) << "behind a back face";
  for (int i = 0; i < 10; ++i) media.cross(surface(i, true, 1));
  EXPECT_FLOAT_EQ(media.transmittance(1).x, std::exp(-1.0F));
}

}  // namespace
}  // namespace chiaro::renderer

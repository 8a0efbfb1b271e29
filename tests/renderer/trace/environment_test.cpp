// Light from environments and from many lights, against closed forms. Bounds are six of the stated standard errors, of
// three degrees of freedom (p < 1 %), where nothing else is said. Seeds are fixed.

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"
#include "renderer/trace/render.h"
#include "renderer/trace/trace_illumination.h"
#include "tests/support/code_scenes.h"
#include "tests/support/directions.h"
#include "tests/support/environments.h"

namespace chiaro::renderer {
namespace {

using test::add_mesh;
using test::environment;
using test::environment_map;
using test::lambert;
using test::plane_scene;
using test::rectangle;

constexpr int kWidth = 64, kHeight = 32;

EnvironmentMap constant_map(Vec3f radiance) {
  return environment_map(kWidth, kHeight, [&](int, int) { return radiance; });
}

TEST(Environment, OfOneRadianceGivesAnOpenPlaneThatIllumination) {
  const Scene scene = plane_scene({0.5F, 0.5F, 0.5F});
  const RayTracer tracer(scene);
  const std::vector<SurfaceSample> points{{{0.3F, 0, 0.2F}, {0, 1, 0}}, {{0.3F, 0, 0.2F}, normalize(Vec3f{1, 1, 0})}};
  for (const int bounces : {0, 3}) {
    const auto result = trace_illumination(tracer, points, {environment(constant_map({3, 2, 1}))},
                                           {.samples = 1024, .bounces = bounces, .seed = 4});
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(result.value[0][c], 3 - c, 6 * result.standard_error[0][c] + 1e-3F);
    }
    // A point that leans by 45 degrees sees (1 + cos 45°) / 2 of the light above the plane that it stands on; what the
    // plane sends comes with bounces.
    const double sky = 3 * (1 + std::sqrt(0.5)) / 2;
    if (bounces == 0) {
      EXPECT_NEAR(result.value[1].x, sky, 6 * double(result.standard_error[1].x) + 1e-3);
    }
    if (bounces > 0) {
      EXPECT_GT(result.value[1].x, sky);
    }
  }
}

TEST(Environment, ASmallBrightSpotIsADirectionalLight) {
  // Of Ω steradians and radiance L: the same as L Ω lux across the direction.
  const int width = 1024, height = 512, x = 300, y = 150;
  const EnvironmentMap map = environment_map(width, height, [&](int i, int j) {
    return i == x && j == y ? Vec3f{1e6F, 1e6F, 1e6F} : Vec3f{};
  });
  const Vec3f to_sun = direction_of_latlong({(x + 0.5F) / width, (y + 0.5F) / height});
  // A bilinear bump of one pixel has the pixel's own integral: its solid angle at its row.
  const double row = M_PI / height, solid_angle = 2 * M_PI / width * row * std::sin(M_PI * (y + 0.5) / height);
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  std::vector<SurfaceSample> points;
  for (int i = 0; i < 20; ++i) points.push_back({{0.2F + 0.18F * float(i), 1e-4F, 3.5F}, {0, 1, 0}});
  const float lux = float(1e6 * solid_angle);
  for (const float turn : {0.0F, 1.2F}) {
    EnvironmentLight sky = environment(map, turn);
    const Lights sun{DirectionalLight{"", -rotate_about_y(to_sun, turn), {lux, lux, lux}}};
    const TraceOptions options{.samples = 256, .bounces = 0, .seed = 4};
    const auto by_sky = trace_illumination(tracer, points, {sky}, options);
    const auto by_sun = trace_illumination(tracer, points, sun, options);
    double lit = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(by_sky.value[i].x, by_sun.value[i].x, 0.01F * by_sun.value[i].x + 1e-4F * lux) << i;
      lit += double(by_sun.value[i].x);
    }
    EXPECT_GT(lit, 0) << "nothing was compared";
  }
}

TEST(Environment, AWhiteBallInAWhiteFurnaceCannotBeSeen) {
  Scene scene;
  add_mesh(scene, test::sphere({0, 0, 0}, 1, 24), lambert({1, 1, 1}), "lambert ball");
  Camera camera;
  camera.world_from_camera = make_transform({0, 0, 4}, {0, 0, 0, 1}, {1, 1, 1});
  const RayTracer tracer(scene);
  RenderOptions options;
  options.width = options.height = 24;
  options.trace = {.samples = 64, .seed = 1};
  options.layers = {"lights"};
  const Frame frame = render(tracer, camera, {environment(constant_map({1, 1, 1}))}, options);
  const int alpha = frame.image.find_channel("A"), layer = frame.image.find_channel("light.environment.R");
  ASSERT_GE(layer, 0);
  EXPECT_EQ(frame.image.at(0, 0)[alpha], 0);
  EXPECT_EQ(frame.image.at(12, 12)[alpha], 1);
  double sum = 0;
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 24; ++x) {
      sum += double(frame.image.at(x, y)[0]);
      EXPECT_NEAR(frame.image.at(x, y)[0], 1, 0.1) << x << " " << y;
      EXPECT_EQ(frame.image.at(x, y)[0], frame.image.at(x, y)[layer]);
    }
  }
  EXPECT_NEAR(sum / (24 * 24), 1, 0.003);
}

TEST(Environment, TheCameraSeesItTheRightWayRound) {
  // The default camera looks along -Z, a quarter from the left; to its right is +X, further right in the picture.
  const EnvironmentMap map = environment_map(kWidth, kHeight, [](int x, int y) {
    return Vec3f{float(x), float(y), 1};
  });
  Scene scene = plane_scene({0, 0, 0});
  scene.instances[0].world_from_object = make_transform({0, -1000, 0}, {0, 0, 0, 1}, {1, 1, 1});
  Camera camera;
  camera.vertical_fov = 2 * std::atan(1.0F);
  const RayTracer tracer(scene);
  RenderOptions options;
  options.width = options.height = 9;
  options.trace = {.samples = 16};
  options.box_filter = true;
  const Image image = render(tracer, camera, {environment(map)}, options).image;
  EXPECT_NEAR(image.at(4, 4)[0], kWidth / 4.0 - 0.5, 0.3);
  EXPECT_NEAR(image.at(4, 4)[1], kHeight / 2.0 - 0.5, 0.3);
  EXPECT_GT(image.at(7, 4)[0], image.at(4, 4)[0] + 4);
  EXPECT_LT(image.at(4, 1)[1], image.at(4, 4)[1] - 3);
  // Turned by 90 degrees to the left, what was on the right, at +X, is in the middle.
  const Image turned = render(tracer, camera, {environment(map, kPi / 2)}, options).image;
  EXPECT_NEAR(turned.at(4, 4)[0], kWidth / 2.0 - 0.5, 0.3);
}

// Lambert's formula: irradiance of a polygon of radiance 1 at a point of normal n,
// ½ Σ β_i n · (v_i × v_i+1) / |v_i × v_i+1|, β_i the angle between corners v_i and v_i+1; all above the horizon.
double lambert_irradiance(const std::vector<Vec3f>& corners, Vec3f at, Vec3f n) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3f a = normalize(corners[i] - at), b = normalize(corners[(i + 1) % corners.size()] - at);
    sum += std::acos(double(dot(a, b))) * double(dot(n, normalize(cross(a, b))));
  }
  return std::abs(sum) / 2;
}

TEST(EmissiveTriangles, AQuadGivesWhatLambertsFormulaSays) {
  const Vec3f corner{-1, 2, 0.5F}, u{1.5F, 0.4F, 0}, v{0.2F, 0.3F, 1.1F};
  Scene scene;
  add_mesh(scene, rectangle(corner, u, v, 3), lambert({0, 0, 0}, {3, 2, 1}), "quad");
  const RayTracer tracer(scene);
  const std::vector<SurfaceSample> points{{{0, 0, 0}, {0, 1, 0}},
                                          {{-0.5F, 1.7F, 0.8F}, normalize(Vec3f{0, 1, 0.2F})},
                                          {{2, 1, 3}, normalize(Vec3f{-1, 0.5F, -1})}};
  const auto result = trace_illumination(tracer, points, {}, {.samples = 4096, .bounces = 0, .seed = 2});
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double expected =
        3 / M_PI *
        lambert_irradiance({corner, corner + u, corner + u + v, corner + v}, points[i].position, points[i].normal);
    EXPECT_NEAR(result.value[i].x, expected, 6 * double(result.standard_error[i].x) + 1e-4 * expected) << i;
    EXPECT_LT(result.standard_error[i].x, 0.02 * expected);
  }
}

Lights lights_in_the_corner(std::size_t count) {
  Lights lights;
  for (std::uint32_t i = 0; i < count; ++i) {
    Sampler sampler(12, 0, i);
    const Vec2f xy = sampler.next_2d();
    const Vec3f at{0.2F + 3.6F * xy.x, 0.2F + 2.6F * xy.y, 0.2F + 3.6F * sampler.next_1d()};
    lights.emplace_back(PointLight{"", at, {0.1F, 0.2F * sampler.next_1d(), 0.1F}});
  }
  return lights;
}

// The sum of what each gives alone, where that needs no chance; the mean of all points to five standard errors.
TEST(ManyLights, AThousandGiveDirectlyWhatTheyGiveOneByOne) {
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  const Lights lights = lights_in_the_corner(1000);
  std::vector<SurfaceSample> points;
  for (int i = 0; i < 50; ++i) points.push_back({{0.1F + 0.076F * float(i), 1e-5F, 3}, {0, 1, 0}});
  const auto sampled = trace_illumination(tracer, points, lights, {.samples = 64, .bounces = 0, .seed = 6});
  const auto exact = trace_illumination(tracer, points, lights, {.samples = 256, .bounces = 0, .seed = 6});
  double difference = 0, error = 0, sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(exact.standard_error[i].x, 0);
    difference += double(sampled.value[i].y - exact.value[i].y);
    error += std::pow(double(sampled.standard_error[i].y), 2);
    sum += double(exact.value[i].y);
  }
  EXPECT_NEAR(difference, 0, 5 * std::sqrt(error));
  EXPECT_LT(std::sqrt(error), 0.02 * sum);
}

TEST(ManyLights, GiveAFrameOfTheSameMeanAsFewAtATime) {
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  const Lights lights = lights_in_the_corner(40);
  Camera camera;
  camera.world_from_camera = make_transform({2.5F, 1.5F, 8}, {0, 0, 0, 1}, {1, 1, 1});
  RenderOptions options;
  options.width = 32;
  options.height = 24;
  options.layers = {"direct", "indirect"};
  const auto sums = [&](const Lights& some, std::uint64_t seed) {
    options.trace = {.samples = 64, .bounces = 2, .seed = seed};
    const Image image = render(tracer, camera, some, options).image;
    std::array<double, 2> sum{};
    for (int y = 0; y < options.height; ++y) {
      for (int x = 0; x < options.width; ++x) {
        sum[0] += double(image.at(x, y)[image.find_channel("direct.R")]);
        sum[1] += double(image.at(x, y)[image.find_channel("indirect.R")]);
      }
    }
    return sum;
  };
  const auto all = sums(lights, 1);
  std::array<double, 2> parts{};
  for (std::size_t first = 0; first < lights.size(); first += 4) {
    const auto part = sums(Lights(lights.begin() + long(first), lights.begin() + long(first + 4)), first + 2);
    for (int k = 0; k < 2; ++k) parts[k] += part[k];
  }
  EXPECT_NEAR(all[0] / parts[0], 1, 0.01);
  EXPECT_NEAR(all[1] / parts[1], 1, 0.02);
}

}  // namespace
}  // namespace chiaro::renderer

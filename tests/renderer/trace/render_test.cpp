// Frames of closed forms. Statistical bounds are five standard errors (p < 0.0001 %), seeds are fixed.

#include "renderer/trace/render.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "renderer/core/error.h"
#include "tests/support/code_scenes.h"

namespace chiaro::renderer {
namespace {

using test::add_mesh;
using test::lambert;
using test::rectangle;

Vec3f rgb(const Image& image, int x, int y, const std::string& layer = "") {
  const int first = image.find_channel(layer.empty() ? "R" : layer + ".R");
  EXPECT_GE(first, 0) << layer;
  const float* p = image.at(x, y) + first;
  return {p[0], p[1], p[2]};
}

Vec3f xyz(const Image& image, int x, int y, const std::string& layer) {
  const float* p = image.at(x, y) + image.find_channel(layer + ".X");
  return {p[0], p[1], p[2]};
}

void expect_close(Vec3f a, Vec3f b, float relative) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], relative * (std::abs(b[c]) + 1e-3F));
}

RenderOptions sized(int width, int height, const TraceOptions& trace) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.trace = trace;
  return options;
}

// Looks down from `height` on the origin; +X to the right, -Z up.
Camera camera_above(float height) {
  Camera camera;
  const float half = std::sqrt(0.5F);
  camera.world_from_camera = make_transform({0, height, 0}, {-half, 0, 0, half}, {1, 1, 1});
  camera.vertical_fov = 2 * std::atan(0.5F);
  return camera;
}

// The corner and its ball, an emissive lamp over it, and sky beside.
Scene corner_with_lamp() {
  Scene scene = test::corner_with_ball();
  add_mesh(scene, rectangle({1, 2.5F, 1}, {1, 0, 0}, {0, 0, 1}), lambert({0, 0, 0}, {5, 4, 3}), "lamp");
  return scene;
}

Lights two_lights() {
  return {PointLight{"key", {3, 2, 3}, {10, 8, 6}},
          SpotLight{"rim.left", {1, 2, 3}, {0, -1, 0}, {9, 9, 9}, 0.3F, 0.7F}};
}

TEST(Render, FurnaceIsOneColourAllOver) {
  Scene scene;
  add_mesh(scene, test::sphere({0, 0, 0}, 2, 32, true), lambert({0.5F, 0.5F, 0.5F}, {1, 2, 3}), "furnace");
  const RayTracer tracer(scene);
  const Frame frame = render(tracer, camera_above(0.5F), {}, sized(16, 12, {.samples = 256, .seed = 4}));
  Vec3f mean;
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 16; ++x) {
      mean += rgb(frame.image, x, y) / (16 * 12);
      expect_close(rgb(frame.image, x, y), {2, 4, 6}, 0.1F);
      EXPECT_EQ(frame.image.at(x, y)[frame.image.find_channel("A")], 1);
    }
  }
  expect_close(mean, {2, 4, 6}, 0.005F);
  EXPECT_LT(frame.relative_standard_error.value(), 0.03);
  EXPECT_EQ(frame.samples, 256);
}

TEST(Render, DirectlyLitPlaneIsItsClosedForm) {
  // Radiance of a Lambert surface of albedo ρ: ρ I cosθ / (π d²).
  Scene scene;
  add_mesh(scene, rectangle({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), lambert({0.5F, 0.25F, 1}), "plane");
  const RayTracer tracer(scene);
  const Vec3f lamp{0.5F, 1.5F, -0.3F};
  const Lights lights{PointLight{"", lamp, {10, 20, 30}}};
  RenderOptions options = sized(32, 32, {.samples = 64, .bounces = 0});
  for (const bool box : {true, false}) {
    options.box_filter = box;
    const Frame frame = render(tracer, camera_above(2), lights, options);
    for (const auto& [x, y] : {std::pair{3, 5}, {16, 16}, {25, 9}, {0, 31}}) {
      // The field is 2 m across at the plane, and z falls towards the top.
      const Vec3f at{(float(x) + 0.5F) / 16 - 1, 0, (float(y) + 0.5F) / 16 - 1};
      const Vec3f d = lamp - at;
      const float share = 1.5F * kInvPi / (length_squared(d) * length(d));
      expect_close(rgb(frame.image, x, y), share * Vec3f{5, 5, 30}, 0.005F);
    }
  }
}

// Floats know less of where a large triangle is than of where a small lamp is, and rays leave the one by more than they
// end before the other. Form factor of a square to what is below its middle: E. M. Sparrow & R. D. Cess, Radiation Heat
// Transfer.
TEST(Render, LampsLightFloorsOfAnySize) {
  const double side = 0.25, slant = std::hypot(1, side);  // of a quarter, metres; at 1 m
  const double form_factor = 4 / kPi * side / slant * std::atan(side / slant);
  for (const float half : {0.6F, 2.0F, 20.0F, 500.0F}) {
    Scene scene;
    add_mesh(scene, rectangle({-half, 0, -half}, {0, 0, 2 * half}, {2 * half, 0, 0}), lambert({1, 1, 1}), "floor");
    add_mesh(scene, rectangle({-0.25F, 1, -0.25F}, {0.5F, 0, 0}, {0, 0, 0.5F}), lambert({0, 0, 0}, {7, 7, 7}), "lamp");
    const RayTracer tracer(scene);
    RenderOptions options = sized(17, 17, {.samples = 1024, .bounces = 0});
    options.box_filter = true;
    const Image image = render(tracer, camera_above(0.5F), {}, options).image;
    EXPECT_NEAR(rgb(image, 8, 8).x, 7 * form_factor, 0.005 * 7 * form_factor) << half;
  }
}

// What rays meet in the coordinates of its object, and what lies almost on a line, is less certain than its place
// tells.
TEST(Render, LampsAreAsBrightWhateverTheirTriangles) {
  const auto seen = [](const Scene& scene) {
    const RayTracer tracer(scene);
    RenderOptions options = sized(1, 1, {.samples = 16384, .bounces = 0});
    options.box_filter = true;
    return double(rgb(render(tracer, camera_above(0.5F), {}, options).image, 0, 0).x);
  };
  Scene floor;
  add_mesh(floor, rectangle({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}), lambert({1, 1, 1}), "floor");
  Scene near = floor, far = floor;
  add_mesh(near, rectangle({-0.25F, 1, -0.25F}, {0.5F, 0, 0}, {0, 0, 0.5F}), lambert({0, 0, 0}, {7, 7, 7}), "lamp");
  const Vec3f away{1000, 800, -500};
  add_mesh(far, rectangle(away + Vec3f{-0.25F, 1, -0.25F}, {0.5F, 0, 0}, {0, 0, 0.5F}), lambert({0, 0, 0}, {7, 7, 7}),
           "lamp");
  far.instances.back().world_from_object = make_transform(-1 * away, {0, 0, 0, 1}, {1, 1, 1});
  far.instances.push_back(far.instances.back());
  far.instances.back().world_from_object = make_transform({0, 100, 0}, {0, 0, 0, 1}, {1, 1, 1});
  EXPECT_NEAR(seen(far) / seen(near), 1, 0.01);

  // A needle against the same one in parts.
  const auto with_needle = [&](int parts, float angle) {
    Scene scene = floor;
    const float sine = std::sin(angle) / std::sqrt(14.0F);
    const Mat4f turn = make_transform({0, 1, 0}, {sine, 2 * sine, 3 * sine, std::cos(angle)}, {1, 1, 1});
    Mesh needle;
    const Vec3f apex{0.3F, 0.01F, 0};
    for (int i = 0; i < parts; ++i) {
      const auto along = [&](int k) { return Vec3f{-5 + 10 * float(k) / float(parts), 0, 0}; };
      const auto first = std::uint32_t(needle.positions.size());
      for (const Vec3f p : {along(i), along(i + 1), apex}) {
        needle.positions.push_back(transform_point(turn, p));
        needle.normals.push_back(normalize(transform_direction(turn, {0, 0, 1})));
      }
      needle.triangles.push_back({first, first + 1, first + 2});
    }
    add_mesh(scene, needle, lambert({0, 0, 0}, {700, 700, 700}), "needle");
    return scene;
  };
  for (const float angle : {0.2F, 0.5F, 0.9F, 1.4F, 2.0F, 2.7F}) {
    EXPECT_NEAR(seen(with_needle(1, angle)) / seen(with_needle(100, angle)), 1, 0.03) << angle;
  }
}

TEST(Render, LayersAddUpToTheBeauty) {
  const Scene scene = corner_with_lamp();
  const RayTracer tracer(scene);
  RenderOptions options = sized(24, 18, {.samples = 16, .seed = 2});
  options.layers = {"direct", "indirect", "lights"};
  const Image image = render(tracer, default_camera(scene), two_lights(), options).image;
  float indirect = 0;
  for (int y = 0; y < 18; ++y) {
    for (int x = 0; x < 24; ++x) {
      const Vec3f beauty = rgb(image, x, y);
      expect_close(rgb(image, x, y, "direct") + rgb(image, x, y, "indirect"), beauty, 1e-5F);
      const Vec3f lights = rgb(image, x, y, "light.key") + rgb(image, x, y, "light.rim_left");
      expect_close(lights + rgb(image, x, y, "light.emission"), beauty, 1e-5F);
      indirect += luminance(rgb(image, x, y, "indirect"));
    }
  }
  EXPECT_GT(indirect, 0);
}

TEST(Render, SeparateLightsAreWhatEachWouldGiveAlone) {
  // Two frames of independent noise; five standard errors of their difference.
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  RenderOptions options = sized(16, 12, {.samples = 256, .seed = 2});
  options.layers = {"lights"};
  const Lights both = two_lights();
  const Frame together = render(tracer, default_camera(scene), both, options);
  options.trace.seed = 3;
  options.layers = {"variance"};
  const Frame alone = render(tracer, default_camera(scene), {both[1]}, options);
  double a = 0, b = 0, variance = 0;
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 16; ++x) {
      a += double(rgb(together.image, x, y, "light.rim_left").y);
      b += double(rgb(alone.image, x, y).y);
      variance += double(rgb(alone.image, x, y, "variance").y);
    }
  }
  EXPECT_GT(b, 0);
  EXPECT_NEAR(a, b, 5 * std::sqrt(2 * variance));
}

// OpenEXR's names of channels are bytes of 255 at most.
TEST(Render, LayersOfLightsWithLongNamesAreTheirOwn) {
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  Lights lights = two_lights();
  for (Light& light : lights) std::visit([](auto& l) { l.name = std::string(199, 'a') + "ü"; }, light);
  RenderOptions options = sized(2, 2, {.samples = 1});
  options.layers = {"lights"};
  const Image image = render(tracer, default_camera(scene), lights, options).image;
  const std::string name = "light." + std::string(199, 'a');
  EXPECT_GE(image.find_channel(name + ".R"), 0);
  EXPECT_GE(image.find_channel(name + "_1.B"), 0);
}

TEST(Render, AlphaIsTheCoverageOfThePixel) {
  // The left half of the frame, up to the middle of column 8, is covered.
  Scene scene;
  add_mesh(scene, rectangle({-2, 0, -2}, {0, 0, 4}, {2 + 0.5F / 16 * 2, 0, 0}), lambert({1, 1, 1}), "half");
  const RayTracer tracer(scene);
  RenderOptions options = sized(16, 16, {.samples = 256});
  options.box_filter = true;
  options.layers = {"depth"};
  const Image image = render(tracer, camera_above(2), {}, options).image;
  const int alpha = image.find_channel("A"), depth = image.find_channel("depth.Z");
  for (int x = 0; x < 16; ++x) {
    const float covered = x < 8 ? 1 : x == 8 ? 0.5F : 0;
    EXPECT_NEAR(image.at(x, 7)[alpha], covered, 0.01F) << x;
    EXPECT_EQ(std::isfinite(image.at(x, 7)[depth]), covered > 0) << x;
  }
}

TEST(Render, GeometryLayersTellWhatIsSeen) {
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  RenderOptions options = sized(20, 16, {.samples = 1, .bounces = 0});
  options.layers = {"albedo", "normal", "position", "depth"};
  const Camera camera = default_camera(scene);
  const Image image = render(tracer, camera, two_lights(), options).image;
  const Vec3f eye = camera.world_from_camera.column(3), backward = camera.world_from_camera.column(2);
  int floor = 0;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 20; ++x) {
      if (image.at(x, y)[3] == 0) continue;
      const Vec3f position = xyz(image, x, y, "position"), normal = xyz(image, x, y, "normal");
      EXPECT_NEAR(image.at(x, y)[image.find_channel("depth.Z")], dot(eye - position, backward), 1e-3F);
      EXPECT_NEAR(length(normal), 1, 1e-4F);
      if (normal.y < 0.999F || std::abs(position.y) > 1e-5F) continue;
      ++floor;
      expect_close(rgb(image, x, y, "albedo"), {0.7F, 0.7F, 0.7F}, 1e-5F);
    }
  }
  EXPECT_GT(floor, 10);
}

TEST(Render, IlluminationLayerIsTheFrameWithoutTheAlbedo) {
  // On Lambert surfaces beauty = albedo × illumination; direct only, so that both are free of noise.
  Scene scene;
  add_mesh(scene, rectangle({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), lambert({0.5F, 0.25F, 0.8F}), "plane");
  const RayTracer tracer(scene);
  RenderOptions options = sized(8, 8, {.samples = 16, .bounces = 0});
  options.layers = {"illumination"};
  const Image image = render(tracer, camera_above(2), {PointLight{"", {0, 1, 0}, {7, 8, 9}}}, options).image;
  for (int x = 0; x < 8; ++x) {
    expect_close(rgb(image, x, 3), Vec3f{0.5F, 0.25F, 0.8F} * rgb(image, x, 3, "illumination"), 1e-5F);
  }
}

TEST(Render, LearnsWhichLightsStandBehindWalls) {
  // A floor, a wall beside it, four lights on this side and sixty on the other.
  Scene scene;
  add_mesh(scene, rectangle({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), lambert({0.5F, 0.5F, 0.5F}), "floor");
  add_mesh(scene, rectangle({1, 0, -5}, {0, 0, 10}, {0, 5, 0}), lambert({0.5F, 0.5F, 0.5F}), "wall");
  const RayTracer tracer(scene);
  Lights lights;
  for (int i = 0; i < 64; ++i) {
    const float x = i < 4 ? -0.5F : 2, z = 0.1F * float(i % 4);
    lights.emplace_back(PointLight{"", {x, 1 + 0.05F * float(i / 4), z}, {10, 10, 10}});
  }
  const Camera camera = camera_above(1);
  const Lights seen(lights.begin(), lights.begin() + 4);
  const Image expected = render(tracer, camera, seen, sized(16, 16, {.samples = 256, .bounces = 0})).image;
  const auto frame = [&](int samples) {
    return render(tracer, camera, lights, sized(16, 16, {.samples = samples, .bounces = 0, .seed = 3}));
  };
  const Frame few = frame(4), many = frame(256);
  double sum = 0, of_expected = 0;
  for (std::size_t i = 0; i < expected.pixels.size(); i += 4) {
    sum += double(many.image.pixels[i]);
    of_expected += double(expected.pixels[i]);
  }
  EXPECT_NEAR(sum / of_expected, 1, 5 * many.relative_standard_error.value() / 16);
  // An eighth of the error is what 64 times the samples bring by themselves.
  EXPECT_LT(many.relative_standard_error.value(), 0.5 * few.relative_standard_error.value() / 8);
}

TEST(Render, SameBytesForAnyNumberOfThreads) {
  const Scene scene = corner_with_lamp();
  const RayTracer tracer(scene);
  Lights lights = two_lights();
  for (int i = 0; i < 6; ++i) lights.emplace_back(PointLight{"", {float(i), 1, 3}, {1, 2, 3}});
  RenderOptions options = sized(32, 24, {.samples = 8, .seed = 9});
  options.layers = frame_layers();
  std::vector<std::vector<float>> pixels;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    pixels.push_back(render(tracer, default_camera(scene), lights, options).image.pixels);
  }
  ASSERT_EQ(pixels[0].size(), pixels[1].size());
  EXPECT_EQ(std::memcmp(pixels[0].data(), pixels[1].data(), pixels[0].size() * sizeof(float)), 0);
}

TEST(Render, StatedErrorIsThatOfRepeatedFrames) {
  // The spread of frames of other seeds around their mean, against the error that each states.
  const Scene scene = corner_with_lamp();
  const RayTracer tracer(scene);
  const Camera camera = default_camera(scene);
  constexpr int kFrames = 64;
  std::vector<Image> frames;
  double stated = 0;
  for (std::uint64_t seed = 0; seed < kFrames; ++seed) {
    const Frame frame = render(tracer, camera, two_lights(), sized(16, 12, {.samples = 16, .seed = seed}));
    stated += std::pow(frame.relative_standard_error.value(), 2) / kFrames;
    frames.push_back(frame.image);
  }
  double spread = 0, value = 0;
  for (std::size_t i = 0; i < frames[0].pixels.size(); ++i) {
    if (i % 4 == 3) continue;  // alpha
    double mean = 0, squares = 0;
    for (const Image& frame : frames) mean += double(frame.pixels[i]) / kFrames;
    for (const Image& frame : frames) squares += std::pow(double(frame.pixels[i]) - mean, 2) / (kFrames - 1);
    spread += squares;
    value += mean * mean;
  }
  // Over other sets of seeds the ratio spreads by some three percent, as a few bright samples have much of the error.
  const double ratio = std::sqrt(spread / value / stated);
  EXPECT_LT(ratio, 1.12);
  EXPECT_GT(ratio, 0.88);
}

TEST(Render, OneSampleDoesNotTellItsNoise) {
  const Scene scene = corner_with_lamp();
  const RayTracer tracer(scene);
  const auto frame = [&](int samples) {
    return render(tracer, default_camera(scene), two_lights(), sized(16, 12, {.samples = samples}));
  };
  EXPECT_FALSE(frame(1).relative_standard_error);
  EXPECT_GT(frame(2).relative_standard_error.value(), 0);
}

TEST(Render, NoiseThresholdSpendsSamplesWhereTheyAreNeeded) {
  const Scene scene = corner_with_lamp();
  const RayTracer tracer(scene);
  RenderOptions options = sized(64, 48, {.samples = 512, .seed = 2});
  options.noise_threshold = 0.1;
  options.layers = {"samples", "variance"};
  const Frame frame = render(tracer, default_camera(scene), two_lights(), options);
  const int samples = frame.image.find_channel("samples.Y");
  float least = kInfinity, most = 0;
  double mean = 0;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const float n = frame.image.at(x, y)[samples];
      least = std::min(least, n), most = std::max(most, n), mean += double(n) / (64 * 48);
    }
  }
  EXPECT_EQ(least, 16);
  EXPECT_EQ(most, float(frame.samples));
  EXPECT_NEAR(mean, frame.mean_samples, 1e-6);
  EXPECT_LT(mean, 256);
  EXPECT_GT(most, 2 * least);
  EXPECT_LT(frame.relative_standard_error.value(), 0.1);
}

TEST(Render, InterruptedFramesAreWholeAndSaySo) {
  const Scene scene = corner_with_lamp();
  const RayTracer tracer(scene);
  std::atomic<bool> interrupted{false};
  Control control;
  control.interrupted = &interrupted;
  control.report = [&](std::string_view, double fraction) { interrupted = interrupted || fraction > 0.1; };
  RenderOptions options = sized(64, 48, {.samples = 256});
  options.layers = {"samples"};
  const Frame frame = render(tracer, default_camera(scene), two_lights(), options, control);
  EXPECT_TRUE(frame.interrupted);
  EXPECT_LT(frame.mean_samples, 100);
  const int samples = frame.image.find_channel("samples.Y");
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) EXPECT_GE(frame.image.at(x, y)[samples], 4);
  }
}

TEST(Render, SamplesThatAreNotFiniteAreDroppedAndCounted) {
  // So close to a light of so many candela that the illuminance overflows.
  Scene scene;
  add_mesh(scene, rectangle({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), lambert({0.5F, 0.5F, 0.5F}), "plane");
  const RayTracer tracer(scene);
  const Lights lights{PointLight{"", {0, 1e-3F, 0}, {3e38F, 3e38F, 3e38F}}};
  RenderOptions options = sized(16, 16, {.samples = 16});
  options.layers = frame_layers();
  const Frame frame = render(tracer, camera_above(2), lights, options);
  EXPECT_GT(frame.dropped_samples, 0U);
  const int depth = frame.image.find_channel("depth.Z");
  const int channels = frame.image.channel_count();
  for (std::size_t i = 0; i < frame.image.pixels.size(); ++i) {
    if (int(i) % channels != depth) {
      EXPECT_TRUE(std::isfinite(frame.image.pixels[i])) << frame.image.channel_names[i % std::size_t(channels)];
    }
  }
}

TEST(Render, AFrameThatThereIsNoTimeForHasItsFirstSamples) {
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  RenderOptions options = sized(16, 16, {.samples = 64});
  options.layers = {"samples"};
  options.time_limit = 1e-9;
  const Frame frame = render(tracer, default_camera(scene), two_lights(), options);
  EXPECT_FALSE(frame.interrupted);
  const int samples = frame.image.find_channel("samples.Y");
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) EXPECT_EQ(frame.image.at(x, y)[samples], 4);
  }
  options.time_limit = 1e9;
  EXPECT_EQ(render(tracer, default_camera(scene), two_lights(), options).samples, 64);
}

TEST(Render, NoiseIsToldAndLayersAreNumbersHoweverBrightOrDim) {
  // The same frame in other units. Variances are held at the largest float.
  Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  const auto lit_by = [&](float candela) {
    RenderOptions options = sized(16, 12, {.samples = 16, .bounces = 2, .seed = 4});
    options.layers = {"variance"};
    return render(tracer, default_camera(scene), {PointLight{"", {3, 2, 3}, {candela, candela, candela}}}, options);
  };
  const double expected = lit_by(1).relative_standard_error.value();
  ASSERT_GT(expected, 0.01);
  for (const float candela : {1e-24F, 1e20F, 1e24F}) {
    const Frame frame = lit_by(candela);
    EXPECT_NEAR(frame.relative_standard_error.value(), expected, 1e-3 * expected) << candela;
    EXPECT_EQ(frame.dropped_samples, 0U) << candela;
    EXPECT_TRUE(std::all_of(frame.image.pixels.begin(), frame.image.pixels.end(), [](float value) {
      return std::isfinite(value);
    })) << candela;
  }
}

TEST(Render, ClampingHoldsEachContributionDown) {
  const Scene scene = corner_with_lamp();
  const RayTracer tracer(scene);
  RenderOptions options = sized(24, 18, {.samples = 16});
  options.layers = {"direct", "indirect", "lights"};
  options.clamp_direct = 0.5F;
  const Image image = render(tracer, default_camera(scene), two_lights(), options).image;
  const Image free = render(tracer, default_camera(scene), two_lights(), sized(24, 18, {.samples = 16})).image;
  double clamped = 0, unclamped = 0;
  for (int y = 0; y < 18; ++y) {
    for (int x = 0; x < 24; ++x) {
      const Vec3f beauty = rgb(image, x, y), direct = rgb(image, x, y, "direct");
      EXPECT_LE(max_component(direct), 4 * 0.5001F);  // two lights, the lamp, and the lamp seen
      expect_close(direct + rgb(image, x, y, "indirect"), beauty, 1e-5F);
      expect_close(
          rgb(image, x, y, "light.key") + rgb(image, x, y, "light.rim_left") + rgb(image, x, y, "light.emission"),
          beauty, 1e-5F);
      clamped += double(beauty.y), unclamped += double(rgb(free, x, y).y);
    }
  }
  EXPECT_LT(clamped, 0.95 * unclamped);
}

TEST(Render, MattesCoverWhatIsHit) {
  const Scene scene = corner_with_lamp();
  const RayTracer tracer(scene);
  RenderOptions options = sized(24, 18, {.samples = 16, .bounces = 0});
  options.layers = {"cryptomatte"};
  const Frame frame = render(tracer, default_camera(scene), two_lights(), options);
  const int first = frame.image.find_channel("CryptoObject00.R");
  ASSERT_GE(first, 0);
  bool ball = false;
  for (int y = 0; y < 18; ++y) {
    for (int x = 0; x < 24; ++x) {
      const float* ranks = frame.image.at(x, y) + first;
      float coverage = 0;
      for (int i = 0; i < kMatteLevels; ++i) {
        coverage += ranks[2 * i + 1];
        if (i > 0) {
          EXPECT_LE(ranks[2 * i + 1], ranks[2 * i - 1]);
        }
        ball = ball || std::bit_cast<std::uint32_t>(ranks[2 * i]) == matte_id("ball");
      }
      EXPECT_NEAR(coverage, frame.image.at(x, y)[3], 1e-5F);
    }
  }
  EXPECT_TRUE(ball);
  EXPECT_EQ(frame.mattes.size(), 2U);
}

TEST(Render, CoarseSpheresHaveASmoothTerminator) {
  // A sphere of 12 bands with vertex normals, and light from the side: wherever the surface faces it by its normals,
  // the picture is the smooth sphere's, ρ E cosθ / π, to the edge of the light.
  Scene scene;
  add_mesh(scene, test::sphere({0, 0, 0}, 1, 12), lambert({0.5F, 0.5F, 0.5F}), "ball");
  const RayTracer tracer(scene);
  const Vec3f to_light = normalize(Vec3f{1, 0.15F, 0});
  RenderOptions options = sized(96, 96, {.samples = 4, .bounces = 0});
  options.box_filter = true;
  options.layers = {"normal"};
  Camera camera = camera_above(4);
  camera.vertical_fov = 0.4F;
  const Image image = render(tracer, camera, {DirectionalLight{"", -to_light, {100, 100, 100}}}, options).image;
  int near_terminator = 0;
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      if (image.at(x, y)[3] < 1) continue;
      const float cosine = dot(xyz(image, x, y, "normal"), to_light);
      const float expected = 0.5F * 100 * kInvPi * std::max(cosine, 0.0F);
      if (cosine < 0.02F) continue;  // where a pixel's samples lie on both sides
      near_terminator += cosine < 0.2F ? 1 : 0;
      EXPECT_NEAR(rgb(image, x, y).x, expected, 0.02F * expected + 0.05F) << x << ", " << y << ": " << cosine;
    }
  }
  EXPECT_GT(near_terminator, 300);
}

TEST(Render, UnknownLayersAreRefused) {
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  RenderOptions options = sized(4, 4, {.samples = 1});
  options.layers = {"direct", "shadow"};
  EXPECT_THROW(render(tracer, default_camera(scene), {}, options), Error);
}

TEST(Render, StopsWhenAskedTo) {
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  const std::atomic<bool> interrupted{true};
  Control control;
  control.interrupted = &interrupted;
  EXPECT_THROW(render(tracer, default_camera(scene), {}, sized(64, 64, {.samples = 64}), control), Interruption);
}

TEST(DefaultCamera, SeesEveryCornerOfTheScene) {
  for (const Vec3f size : {Vec3f{4, 3, 4}, Vec3f{100, 1, 1}, Vec3f{0.001F, 0.02F, 0.001F}, Vec3f{1, 1, 50}}) {
    Scene scene;
    add_mesh(scene, test::room(size), lambert({1, 1, 1}), "room");
    scene.instances[0].world_from_object = make_transform({7, -3, 2}, {0, 0, 0, 1}, {1, 1, 1});
    const Camera camera = default_camera(scene);
    const Mat4f camera_from_world = inverse_affine(camera.world_from_camera);
    const float half_height = std::tan(0.5F * camera.vertical_fov);
    for (const Vec3f p : scene.meshes[0].positions) {
      const Vec3f seen = transform_point(camera_from_world, p + Vec3f{7, -3, 2});
      EXPECT_LT(seen.z, 0);
      EXPECT_LT(std::abs(seen.y / seen.z), half_height);
      EXPECT_LT(std::abs(seen.x / seen.z), half_height * 16 / 9);
    }
  }
}

}  // namespace
}  // namespace chiaro::renderer

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/camera_choice.h"
#include "cli/common_options.h"
#include "cli/frame_metadata.h"
#include "cli/frame_output.h"
#include "cli/usage_error.h"
#include "renderer/core/error.h"
#include "tests/support/code_scenes.h"

namespace chiaro::cli {
namespace {

using renderer::Camera;
using renderer::Mat4f;
using renderer::Vec3f;

std::array<float, 16> matrix_named(const renderer::Attributes& attributes, const std::string& name) {
  for (const auto& [key, value] : attributes) {
    if (key == name) return std::get<std::array<float, 16>>(value);
  }
  ADD_FAILURE() << "no attribute " << name;
  return {};
}

// A row vector times a row-major matrix, as OpenEXR's readers do it.
Vec3f times_row_vector(Vec3f p, const std::array<float, 16>& m) {
  const float w = p.x * m[3] + p.y * m[7] + p.z * m[11] + m[15];
  return Vec3f{p.x * m[0] + p.y * m[4] + p.z * m[8] + m[12], p.x * m[1] + p.y * m[5] + p.z * m[9] + m[13],
               p.x * m[2] + p.y * m[6] + p.z * m[10] + m[14]} /
         w;
}

// At (1, 2, 3), looking along +X, so that its right is +Z. A node above scales it.
Camera camera_looking_along_x() {
  Camera camera;
  const float s = 2;
  camera.world_from_camera.m = {0, 0, s, 0, 0, s, 0, 0, -s, 0, 0, 0, 1, 2, 3, 1};
  camera.vertical_fov = 2 * std::atan(0.5F);
  return camera;
}

void expect_near(Vec3f a, Vec3f b) { EXPECT_LT(renderer::length(a - b), 1e-5F) << a.x << " " << a.y << " " << a.z; }

// Those of ours; of the first two their names alone.
std::string text_of(const renderer::Attributes& attributes) {
  std::string text;
  for (const auto& [name, value] : attributes) {
    if (!name.starts_with("chiaro:")) continue;
    text += name.substr(7);
    if (const auto* words = std::get_if<std::string>(&value)) {
      if (name != "chiaro:version" && name != "chiaro:units") text += "=" + *words;
    } else if (const auto* number = std::get_if<float>(&value)) {
      text += fmt::format("={:g}", *number);
    } else {
      text += fmt::format("={}", std::get<int>(value));
    }
    text += "|";
  }
  return text;
}

TEST(CliFrameMetadata, WorldToCameraLooksAlongZAsOpenExrDefinesIt) {
  const auto matrix = matrix_named(frame_attributes(camera_looking_along_x(), 2, {}), "worldToCamera");
  expect_near(times_row_vector({5, 2, 3}, matrix), {0, 0, 4});
  expect_near(times_row_vector({1, 2, 4}, matrix), {1, 0, 0});
}

TEST(CliFrameMetadata, WorldToNdcMapsTheFramesUpperLeftCornerToZeroAndTheLowerRightToOne) {
  const auto matrix = matrix_named(frame_attributes(camera_looking_along_x(), 2, {}), "worldToNDC");
  // Four metres ahead the frame is 4 m high and 8 m wide.
  const Vec3f upper_right = times_row_vector({5, 2 + 2, 3 + 4}, matrix);
  EXPECT_NEAR(upper_right.x, 1, 1e-5);
  EXPECT_NEAR(upper_right.y, 0, 1e-5);
  const Vec3f lower_left = times_row_vector({5, 2 - 2, 3 - 4}, matrix);
  EXPECT_NEAR(lower_left.x, 0, 1e-5);
  EXPECT_NEAR(lower_left.y, 1, 1e-5);
  const Vec3f middle = times_row_vector({5, 2, 3}, matrix);
  EXPECT_NEAR(middle.x, 0.5F, 1e-5);
  EXPECT_NEAR(middle.y, 0.5F, 1e-5);
}

TEST(CliFrameMetadata, DepthRunsFromMinusOneToOne) {
  for (const bool orthographic : {false, true}) {
    Camera camera;
    camera.orthographic = orthographic;
    camera.near = 0.5F;
    camera.far = 20;
    const auto matrix = row_vector_matrix(ndc_from_camera(camera, 1));
    EXPECT_NEAR(times_row_vector({0, 0, -0.5F}, matrix).z, -1, 1e-5);
    EXPECT_NEAR(times_row_vector({0, 0, -20}, matrix).z, 1, 1e-5);
  }
}

TEST(CliFrameMetadata, OrthographicWidthFollowsTheFrame) {
  Camera camera;
  camera.orthographic = true;
  camera.half_height = 2;
  const auto matrix = row_vector_matrix(ndc_from_camera(camera, 1.5));
  const Vec3f corner = times_row_vector({3, -2, -1}, matrix);
  EXPECT_NEAR(corner.x, 1, 1e-5);
  EXPECT_NEAR(corner.y, 1, 1e-5);
}

TEST(CliFrameMetadata, TheScreenIsAsWideAsTheFieldOfView) {
  const auto attributes = frame_attributes(camera_looking_along_x(), 2, {});
  const auto width = std::find_if(attributes.begin(), attributes.end(),
                                  [](const auto& attribute) { return attribute.first == "screenWindowWidth"; });
  ASSERT_NE(width, attributes.end());
  EXPECT_NEAR(std::get<float>(width->second), 2, 1e-5);  // of 2 m by 1 m a metre away
}

TEST(CliFrameMetadata, SameFrameHasTheSameAttributes) {
  const FrameOrigin origin{.scene = "a.glb", .materials = "gltf", .seed = 7, .bounces = 2};
  EXPECT_EQ(frame_attributes(camera_looking_along_x(), 2, origin),
            frame_attributes(camera_looking_along_x(), 2, origin));
}

TEST(CliFrameMetadata, HoldsWhatWasChosen) {
  FrameOrigin origin{.scene = "a.glb", .materials = "gltf", .seed = 7, .bounces = 2};
  EXPECT_EQ(text_of(frame_attributes({}, 2, origin)).find("environment"), std::string::npos);
  origin.hide_backs = true;
  origin.light_file = "lamps.json";
  origin.variant = "night";
  origin.animation = {.animation = "dusk", .seconds = 1.5};
  origin.environment = renderer::EnvironmentLight{
      .name = {}, .map = {}, .rotation = renderer::kPi / 2, .intensity = 3, .image = "skies/noon.exr"};
  EXPECT_EQ(text_of(frame_attributes({}, 2, origin)),
            "version|units|scene=a.glb|camera=|materials=gltf|bounces=2|seed=7|hide_backs=1|lights=lamps.json|"
            "variant=night|animation=dusk|animation_time=1.5|environment=noon.exr|environment_rotation=90|"
            "environment_intensity=3|");
}

TEST(CliFrameSize, WhatIsMissingComesFromTheAspectRatio) {
  Camera camera;
  camera.aspect_ratio = 2;
  EXPECT_EQ(frame_size(camera, {}), (std::array<int, 2>{960, 480}));
  EXPECT_EQ(frame_size(camera, {.width = 100, .height = {}}), (std::array<int, 2>{100, 50}));
  EXPECT_EQ(frame_size(camera, {.width = {}, .height = 100}), (std::array<int, 2>{200, 100}));
  EXPECT_EQ(frame_size(camera, {.width = 30, .height = 70}), (std::array<int, 2>{30, 70}));
  camera.aspect_ratio = 0;
  EXPECT_EQ(frame_size(camera, {}), (std::array<int, 2>{960, 540}));
}

TEST(CliFrameSize, FramesBeyondReasonAreRefused) {
  EXPECT_EQ(frame_size({}, {.width = 16384, .height = 16384}), (std::array<int, 2>{16384, 16384}));
  EXPECT_THROW(frame_size({}, {.width = 16385, .height = 16384}), UsageError);
  EXPECT_THROW(frame_size({}, {.width = 65536, .height = 65536}), UsageError);
  Camera thin;
  thin.aspect_ratio = 1e-6F;
  EXPECT_EQ(frame_size(thin, {.width = 4, .height = {}}), (std::array<int, 2>{4, 65536}));
}

TEST(CliCameraChoice, UnknownNamesListTheKnown) {
  Session session(CommonOptions{.threads = 0, .seed = 0, .json = false, .quiet = true});
  renderer::Scene scene;
  scene.cameras.resize(2);
  scene.cameras[0].name = "front";
  scene.cameras[1].name = "door";
  EXPECT_EQ(choose_camera(scene, "", {}, session).name, "front");
  EXPECT_EQ(choose_camera(scene, "door", {}, session).name, "door");
  try {
    choose_camera(scene, "window", {}, session);
    FAIL() << "no error";
  } catch (const renderer::Error& error) {
    EXPECT_NE(std::string(error.what()).find("front, door"), std::string::npos) << error.what();
  }
}

TEST(CliCameraChoice, TheOneForScenesWithoutAnySeesAllInFramesOfAnyShape) {
  Session session(CommonOptions{.threads = 0, .seed = 0, .json = false, .quiet = true});
  renderer::Scene scene;
  test::add_mesh(scene, test::rectangle({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), {}, "floor");
  for (const auto& [width, height] : {std::pair{160, 90}, {60, 180}}) {
    const Camera camera = choose_camera(scene, "", {width, height}, session);
    const auto matrix = row_vector_matrix(ndc_from_camera(camera, double(width) / height) *
                                          renderer::inverse_affine(camera.world_from_camera));
    for (const Vec3f& corner : {Vec3f{-1, 0, -1}, {1, 0, -1}, {-1, 0, 1}, {1, 0, 1}}) {
      const Vec3f seen = times_row_vector(corner, matrix);
      for (int a = 0; a < 2; ++a) EXPECT_TRUE(0 < seen[a] && seen[a] < 1) << width << ' ' << a;
    }
  }
}

TEST(CliFrameOutput, OnlyColoursAreConverted) {
  const renderer::Image image = renderer::make_image(
      1, 1,
      {"R", "G", "B", "A", "albedo.R", "albedo.G", "albedo.B", "normal.X", "depth.Z", "variance.R", "light.lamp.R"});
  EXPECT_EQ(color_layers(image), (std::vector<std::string>{"", "albedo", "light.lamp"}));
}

// Sunny 16: f/16 at 1/ISO seconds is the exposure of a sunlit scene, whose brightest matt surfaces show 30 000 cd/m².
TEST(CliCameraExposure, ShowsWhatSaturatesTheFilmAsOne) {
  const LensOptions sunny{.f_number = 16, .focus_distance = {}, .focal_length = {}, .shutter = 0.01F, .iso = 100};
  EXPECT_NEAR(camera_exposure(sunny), -std::log2(120.0F * 16 * 16 / (0.01F * 100)), 1e-4);
  EXPECT_NEAR(30000 * std::exp2(camera_exposure(sunny)), 1, 0.05);
  EXPECT_EQ(camera_exposure({.f_number = 16, .focus_distance = {}, .focal_length = {}, .shutter = {}}), 0);
}

TEST(CliAutoExposure, BringsTheLogAverageToMiddleGrey) {
  renderer::Image image = renderer::make_image(2, 2, {"R", "G", "B"});
  const float nan = std::nanf("");
  image.pixels = {36, 36, 36, 0.09F, 0.09F, 0.09F, 0, 0, 0, nan, 1, 1};
  const float log_average = std::sqrt(36.0F * 0.09F);
  EXPECT_NEAR(auto_exposure(image), std::log2(0.18F / log_average), 1e-4);
  EXPECT_EQ(auto_exposure(renderer::make_image(2, 2, {"R", "G", "B"})), 0);
}

}  // namespace
}  // namespace chiaro::cli

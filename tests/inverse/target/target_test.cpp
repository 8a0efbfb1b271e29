#include "inverse/target/target.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "renderer/core/error.h"
#include "tests/inverse/target/foreign_mesh.h"
#include "tests/inverse/target/surfaces.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::inverse {
namespace {

using test::TemporaryFolder;
using tests::ForeignNode;
using tests::join;
using tests::make_floor;
using tests::make_sheet;
using tests::make_target;
using tests::write_foreign_mesh;

const std::vector<float> kValues{1, 2, 3, 4, 5, 6, 7, 8, 9};
const std::vector<Vec3f> kWanted{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};

Target load_nodes(const std::vector<ForeignNode>& nodes, float target_scale = 1) {
  const TemporaryFolder folder;
  return load_target(write_foreign_mesh(folder, nodes), target_scale);
}

void expect_error(const std::vector<ForeignNode>& nodes, const std::string& part_of_message) {
  try {
    load_nodes(nodes);
    ADD_FAILURE() << "no error: " << part_of_message;
  } catch (const renderer::Error& error) {
    EXPECT_NE(std::string(error.what()).find(part_of_message), std::string::npos) << error.what();
    EXPECT_NE(error.parts().file.find("target.gltf"), std::string::npos) << error.what();
  }
}

// Two parts, values with all their bits in use, some of them brighter than what programs show as white.
Target make_rich_target() {
  Target target = make_target(join(make_floor(), make_sheet({0, 2, 0}, {1, 0, 0}, {0, 0, 1}, 5)), {});
  for (std::size_t i = 0; i < target.illumination.size(); ++i) {
    const float x = float(i) + 0.1F;
    target.illumination[i] = {x / 3, std::exp(x / 10), i % 7 == 0 ? 0 : 1 / x};
    target.weight[i] = i % 5 == 0 ? 0 : x / 7;
    target.standard_error.push_back(x / 1000);
  }
  return target;
}

TEST(Target, KnowsWhetherAScaleIsInIt) {
  EXPECT_TRUE(load_nodes({{"a", {{"COLOR_0", kValues}}}, {"b", {{"_ILLUMINATION", kValues}}}}).has_scaled_colors);
  EXPECT_FALSE(load_nodes({{"a", {{"COLOR_0", kValues}, {"_ILLUMINATION", kValues}}}, {"b", {}}}).has_scaled_colors);
}

TEST(Target, ComesBackFromItsFileBitForBit) {
  const TemporaryFolder folder;
  const Target saved = make_rich_target();
  for (const char* name : {"target.glb", "target.gltf"}) {
    SCOPED_TRACE(name);
    save_target(saved, folder.path() / name);
    const Target loaded = load_target(folder.path() / name, 5);
    EXPECT_EQ(loaded.illumination, saved.illumination);
    EXPECT_EQ(loaded.weight, saved.weight);
    EXPECT_EQ(loaded.standard_error, saved.standard_error);
    EXPECT_EQ(loaded.receivers.positions, saved.receivers.positions);
    EXPECT_EQ(loaded.receivers.normals, saved.receivers.normals);
    EXPECT_EQ(loaded.receivers.triangles, saved.receivers.triangles);
    EXPECT_EQ(fingerprint(loaded.receivers), fingerprint(saved.receivers));
  }
}

TEST(Target, WithoutStandardErrorComesBackWithoutIt) {
  const TemporaryFolder folder;
  Target saved = make_rich_target();
  saved.standard_error.clear();
  save_target(saved, folder.path() / "target.glb");
  EXPECT_TRUE(load_target(folder.path() / "target.glb").standard_error.empty());
}

TEST(Target, OfAnotherProgramIsRead) {
  const Target target = load_nodes({{"a", {{"_ILLUMINATION", kValues}, {"_WEIGHT", {0, 0.5F, 2}}}}});
  EXPECT_EQ(target.illumination, kWanted);
  EXPECT_EQ(target.weight, (std::vector<float>{0, 0.5F, 2}));
  EXPECT_TRUE(target.standard_error.empty());
  EXPECT_EQ(target.receivers.positions, (std::vector<Vec3f>{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}));
  EXPECT_EQ(target.receivers.normals[0], (Vec3f{0, 1, 0}));
}

TEST(Target, WithoutWeightsWeighsOne) {
  EXPECT_EQ(load_nodes({{"a", {{"_ILLUMINATION", kValues}}}}).weight, std::vector<float>(3, 1));
}

TEST(Target, VertexColorsTimesTheScaleStandInForIllumination) {
  const std::vector<float> colors{0.25F, 0.5F, 0.75F, 1, 0, 0, 0, 0, 0};
  const Target target = load_nodes({{"a", {{"COLOR_0", colors}}}}, 40);
  EXPECT_EQ(target.illumination, (std::vector<Vec3f>{{10, 20, 30}, {40, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(load_nodes({{"a", {{"COLOR_0", colors}, {"_ILLUMINATION", kValues}}}}, 40).illumination, kWanted);
}

TEST(Target, OfAPartWithoutValuesNothingIsWanted) {
  const Target target = load_nodes({{"a", {{"_ILLUMINATION", kValues}}}, {"b", {{"_WEIGHT", {1, 1, 1}}}}});
  EXPECT_EQ(target.weight, (std::vector<float>{1, 1, 1, 0, 0, 0}));
  EXPECT_EQ(target.illumination[4], (Vec3f{0, 0, 0}));
}

TEST(Target, StandardErrorIsKnownOnlyIfEveryPartHasIt) {
  const ForeignNode with{"a", {{"_ILLUMINATION", kValues}, {"_STANDARD_ERROR", {1, 2, 3}}}};
  const ForeignNode without{"b", {{"_ILLUMINATION", kValues}}}, unpainted{"c", {}};
  EXPECT_EQ(load_nodes({with}).standard_error, (std::vector<float>{1, 2, 3}));
  EXPECT_TRUE(load_nodes({with, without}).standard_error.empty());
  EXPECT_EQ(load_nodes({with, unpainted}).standard_error, (std::vector<float>{1, 2, 3, 0, 0, 0}));
}

TEST(Target, EmptyTargetsAreErrors) {
  const std::vector<float> black(9, 0);
  expect_error({{"a", {}}}, "an empty target");
  expect_error({{"a", {{"_WEIGHT", {1, 1, 1}}}}}, "an empty target");
  expect_error({{"a", {{"_ILLUMINATION", black}}}}, "an empty target");
  const TemporaryFolder folder;
  EXPECT_EQ(load_illumination(write_foreign_mesh(folder, {{"a", {{"_ILLUMINATION", black}}}})).illumination.size(), 3U);
  expect_error({{"a", {{"COLOR_0", black}}}}, "an empty target");
  expect_error({{"a", {{"_ILLUMINATION", kValues}, {"_WEIGHT", {0, 0, 0}}}}}, "an empty target");
  expect_error({{"a", {{"_ILLUMINATION", {0, 0, 0, 0, 0, 0, 7, 8, 9}}, {"_WEIGHT", {1, 1, 0}}}}}, "an empty target");
}

TEST(Target, WantsLightWhereItIsWeighedAndBrightEnough) {
  const auto wants = [](float weight, float bright) {
    Target target;
    target.weight = {1, weight};
    target.illumination = {{}, {0, bright, 0}};
    return wants_light(target);
  };
  EXPECT_TRUE(wants(1, kDimmest));
  EXPECT_FALSE(wants(1, kDimmest / 2));
  EXPECT_FALSE(wants(0, 1));
}

TEST(Target, ValuesThatCannotBeAreErrors) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  expect_error({{"a", {{"_ILLUMINATION", kValues}, {"_WEIGHT", {1, -1, 1}}}}}, "_WEIGHT");
  expect_error({{"a", {{"_ILLUMINATION", kValues}, {"_WEIGHT", {1, nan, 1}}}}}, "_WEIGHT");
  expect_error({{"a", {{"_ILLUMINATION", {1, 1, 1, 1, -1, 1, 1, 1, 1}}}}}, "node \"a\", vertex 1");
  expect_error({{"a", {{"_ILLUMINATION", {1, 1, 1, 1, infinity, 1, 1, 1, 1}}}}}, "_ILLUMINATION");
  expect_error({{"a", {{"_ILLUMINATION", {1, 1, 1}}}}}, "_ILLUMINATION");
  expect_error({{"a", {{"_ILLUMINATION", kValues}, {"_STANDARD_ERROR", {1, 1, -1}}}}}, "_STANDARD_ERROR");
}

TEST(Target, WhatWouldBeRefusedIsNotWritten) {
  const TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float value : {1e25F, std::numeric_limits<float>::infinity(), nan}) {
    Target target = make_rich_target();
    target.illumination[83].y = value;
    try {
      save_target(target, folder.path() / "target.glb");
      ADD_FAILURE() << value;
    } catch (const renderer::Error& error) {
      EXPECT_NE(error.parts().place.find("vertex 2"), std::string::npos) << error.what();
    }
    EXPECT_FALSE(exists(folder.path() / "target.glb"));
  }
}

TEST(Target, AScaleThatIsNoScaleIsAnError) {
  for (const float scale : {0.0F, -1.0F, std::numeric_limits<float>::infinity()}) {
    EXPECT_THROW(load_nodes({{"a", {{"COLOR_0", kValues}}}}, scale), renderer::Error) << scale;
  }
  EXPECT_THROW(load_nodes({{"a", {{"COLOR_0", kValues}}}}, std::numeric_limits<float>::max()), renderer::Error);
}

TEST(StandardErrorPerReceiver, IsTheRootMeanSquareOfTheChannels) {
  renderer::Illumination illumination;
  illumination.standard_error = {{3, 3, 3}, {1, 2, 2}, {0, 0, 0}};
  const std::vector<float> found = standard_error_per_receiver(illumination);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_FLOAT_EQ(found[0], 3);
  EXPECT_FLOAT_EQ(found[1], std::sqrt(3.0F));
  EXPECT_EQ(found[2], 0);
}

TEST(StandardErrorPerReceiver, IsANumberHoweverBrightOrDim) {
  for (const float error : {1e-24F, 1e24F}) {
    renderer::Illumination illumination;
    illumination.standard_error = {{error, error, error}};
    EXPECT_FLOAT_EQ(standard_error_per_receiver(illumination)[0], error);
  }
}

}  // namespace
}  // namespace chiaro::inverse

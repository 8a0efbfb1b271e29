#include "renderer/io/light_file.h"

#include <gtest/gtest.h>

#include "renderer/io/save_gltf.h"
#include "tests/renderer/io/gltf_builder.h"
#include "tests/support/test_names.h"

namespace chiaro::renderer::tests {
namespace {

using renderer::Lights;
using renderer::load_lights;
using renderer::Vec3f;

TEST(LightFile, WhatIsSavedComesBackBitByBit) {
  const TemporaryFolder folder;
  const Vec3f direction = normalize(Vec3f{1, -2, 3});
  const Lights lights{renderer::PointLight{"key \"1\"", {0.1F, 1e-7F, -12345.678F}, {1.0F / 3, 0, 4e7F}},
                      renderer::SpotLight{"rim", {1, 2, 3}, direction, {7, 8, 9}, 0.123456789F, 0.7F},
                      renderer::DirectionalLight{"sun", {0, -1, 0}, {1e5F, 9e4F, 8e4F}}};
  save_lights(lights, folder / "lights.json");
  const Lights loaded = load_lights(folder / "lights.json");
  ASSERT_EQ(loaded.size(), 3U);
  const auto& point = std::get<renderer::PointLight>(loaded[0]);
  EXPECT_EQ(point.name, "key \"1\"");
  EXPECT_EQ(point.position, (Vec3f{0.1F, 1e-7F, -12345.678F}));
  EXPECT_EQ(point.intensity, (Vec3f{1.0F / 3, 0, 4e7F}));
  const auto& spot = std::get<renderer::SpotLight>(loaded[1]);
  EXPECT_EQ(spot.direction, direction);
  EXPECT_EQ(spot.inner_cone_angle, 0.123456789F);
  EXPECT_EQ(spot.outer_cone_angle, 0.7F);
  EXPECT_EQ(std::get<renderer::DirectionalLight>(loaded[2]).illuminance, (Vec3f{1e5F, 9e4F, 8e4F}));
}

TEST(LightFile, PointIsTheDefaultTypeAndNamesAreOptional) {
  const TemporaryFolder folder;
  const auto path = folder.write("lights.json", R"({"lights":[{"position":[1,2,3],"intensity":[4,5,6]}]})");
  const Lights lights = load_lights(path);
  ASSERT_EQ(lights.size(), 1U);
  EXPECT_EQ(std::get<renderer::PointLight>(lights[0]).intensity, (Vec3f{4, 5, 6}));
  EXPECT_EQ(name_of(lights[0]), "light 0");
}

TEST(LightFile, WhatIsNotReadIsSaid) {
  const TemporaryFolder folder;
  const auto path = folder.write("lights.json", R"({"lights":[
    {"type":"spot","position":[1,2,3],"direction":[0,-1,0],"intensity":[4,5,6],"outer_cone_angel":0.3},
    {"position":[1,2,3],"intensity":[4,5,6],"contribution":0.5,"outer_cone_angel":0.3,"note":"x"}]})");
  std::vector<std::string> warnings;
  EXPECT_EQ(load_lights(path, warnings).size(), 2U);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0], path.string() + ": not read of its lights: note, outer_cone_angel");
}

TEST(LightFile, FieldsOfOtherTypesAreNotRead) {
  const TemporaryFolder folder;
  const auto unread = [&](const std::string& light) {
    const auto path = folder.write("lights.json", "{\"lights\":[" + light + "]}");
    std::vector<std::string> warnings;
    load_lights(path, warnings);
    const std::string before = path.string() + ": not read of its lights: ";
    return warnings.empty() ? "" : warnings.at(0).substr(before.size());
  };
  const std::string point = R"({"position":[1,2,3],"intensity":[4,5,6])", cone = R"(,"direction":[0,-1,0],
                    "inner_cone_angle":0.1,"outer_cone_angle":0.3)";
  EXPECT_EQ(unread(point + cone + "}"), "direction, inner_cone_angle, outer_cone_angle");
  EXPECT_EQ(unread(point + cone + R"(,"type":"spot"})"), "");
  EXPECT_EQ(unread(point + cone + R"(,"type":"directional"})"), "inner_cone_angle, outer_cone_angle, position");
  EXPECT_EQ(unread(point + R"(,"image":"sky.exr","rotation":1})"), "image, rotation");
}

TEST(LightFile, DirectionsBecomeUnitVectors) {
  const TemporaryFolder folder;
  const auto path =
      folder.write("lights.json", R"({"lights":[{"type":"directional","direction":[0,-5,0],"intensity":[1,1,1]}]})");
  EXPECT_EQ(std::get<renderer::DirectionalLight>(load_lights(path).at(0)).direction, (Vec3f{0, -1, 0}));
}

TEST(LightFile, ScenesAreLightFilesToo) {
  const TemporaryFolder folder;
  const auto scene = folder.write("scene.glb", triangle_scene().glb());
  EXPECT_NE(error_of([&] { load_lights(scene); }).find("there are none"), std::string::npos);
  for (const char* name : {"lit.glb", "lit.gltf"}) {
    renderer::save_gltf_with_lights(scene, {renderer::PointLight{"key", {1, 2, 3}, {4, 4, 4}}}, folder / name, {});
    EXPECT_EQ(std::get<renderer::PointLight>(load_lights(folder / name).at(0)).position, (Vec3f{1, 2, 3}));
  }
}

struct BadLights {
  const char* name;
  const char* json;
  const char* expected;
};

class BadLightFile : public testing::TestWithParam<BadLights> {};

TEST_P(BadLightFile, IsRefusedNamingTheLightAndTheField) {
  const TemporaryFolder folder;
  const auto path = folder.write("lights.json", GetParam().json);
  const std::string message = error_of([&] { load_lights(path); });
  EXPECT_NE(message.find("lights.json: "), std::string::npos) << message;
  EXPECT_NE(message.find(GetParam().expected), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadLightFile,
    testing::Values(
        BadLights{"Empty", "", "JSON"}, BadLights{"HalfAnObject", "{", "JSON"}, BadLights{"AList", "[]", "lights"},
        BadLights{"LightsAreANumber", R"({"lights":3})", "lights: is not an array"},
        BadLights{"NoLights", R"({"lights":[]})", "there are none"},
        BadLights{"ALightIsANumber", R"({"lights":[4]})", "lights[0]"},
        BadLights{"NoIntensity", R"({"lights":[{"position":[1,2,3]}]})", "lights[0].intensity: is missing"},
        BadLights{"NoPosition", R"({"lights":[{"intensity":[1,2,3]}]})", "lights[0].position: is missing"},
        BadLights{"TwoCoordinates", R"({"lights":[{"position":[1,2],"intensity":[1,1,1]}]})", "lights[0].position"},
        BadLights{"ACoordinateIsText", R"({"lights":[{"position":[1,2,"3"],"intensity":[1,1,1]}]})",
                  "lights[0].position"},
        BadLights{"InfiniteAsFloat", R"({"lights":[{"position":[1,2,1e300],"intensity":[1,1,1]}]})",
                  "position: is not finite"},
        BadLights{"BeyondTheWorld", R"({"lights":[{"position":[1,-2e9,3],"intensity":[1,1,1]}]})",
                  "lights[0].position: is too far away (expected within 1e+09 m of the origin)"},
        BadLights{"TooBright", R"({"lights":[{"position":[1,2,3],"intensity":[1,1e25,1]}]})",
                  "lights[0].intensity: is too bright (expected at most 1e+24 candela)"},
        BadLights{"InfiniteAsDouble", R"({"lights":[{"position":[1,2,1e999],"intensity":[1,1,1]}]})", "out of range"},
        BadLights{"NegativeIntensity", R"({"lights":[{"position":[1,2,3],"intensity":[1,-1,1]}]})",
                  "lights[0].intensity: is negative"},
        BadLights{"IntensityIsANumber", R"({"lights":[{"position":[1,2,3],"intensity":5}]})", "lights[0].intensity"},
        BadLights{"UnknownType", R"({"lights":[{"type":"lamp"}]})", "lights[0].type: is \"lamp\""},
        BadLights{"TypeIsANumber", R"({"lights":[{"type":7}]})", "lights[0].type"},
        BadLights{"NoDirection", R"({"lights":[{"type":"directional","direction":[0,0,0],"intensity":[1,1,1]}]})",
                  "lights[0].direction: is zero"},
        BadLights{"WideCone", R"({"lights":[{"type":"spot","position":[0,0,0],"direction":[0,0,1],"intensity":[1,1,1],
                  "outer_cone_angle":3}]})",
                  "outer_cone_angle"},
        BadLights{"InnerConeWiderThanOuter",
                  R"({"lights":[{"type":"spot","position":[0,0,0],"direction":[0,0,1],"intensity":[1,1,1],
                  "inner_cone_angle":0.5,"outer_cone_angle":0.2}]})",
                  "outer_cone_angle"}),
    test::kByName);

}  // namespace
}  // namespace chiaro::renderer::tests

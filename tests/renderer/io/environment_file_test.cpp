#include "renderer/io/environment_file.h"

#include <limits>

#include <gtest/gtest.h>

#include "renderer/core/world_limits.h"
#include "renderer/image/image_file.h"
#include "renderer/io/light_file.h"
#include "renderer/io/save_gltf.h"
#include "tests/renderer/io/gltf_builder.h"
#include "tests/support/test_names.h"

namespace chiaro::renderer::tests {
namespace {

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

Image grey_image(int width, int height, float value) {
  Image image = make_image(width, height, {"R", "G", "B"});
  std::fill(image.pixels.begin(), image.pixels.end(), value);
  return image;
}

TEST(EnvironmentFile, KeepsSceneLinearPixels) {
  const TemporaryFolder folder;
  Image image = grey_image(4, 2, 0.25F);
  image.at(3, 1)[0] = 1000;
  save_image(image, folder / "sky.exr", PixelType::kFloat);
  std::vector<std::string> warnings;
  const EnvironmentLight light = load_environment(folder / "sky.exr", warnings);
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(light.name, "environment");
  EXPECT_EQ(light.map->width, 4);
  EXPECT_EQ(light.map->at(0, 0), (Vec3f{0.25F, 0.25F, 0.25F}));
  EXPECT_EQ(light.map->at(3, 1), (Vec3f{1000, 0.25F, 0.25F}));
}

TEST(EnvironmentFile, ReadsRadianceFiles) {
  const TemporaryFolder folder;
  save_image(grey_image(8, 4, 3), folder / "sky.hdr", PixelType::kFloat);
  std::vector<std::string> warnings;
  EXPECT_NEAR(load_environment(folder / "sky.hdr", warnings).map->at(2, 2).y, 3, 0.02);
}

TEST(EnvironmentFile, MakesTheSrgbCurveLinear) {
  const TemporaryFolder folder;
  save_image(grey_image(4, 2, 188.0F / 255), folder / "sky.png", PixelType::kUint8);
  std::vector<std::string> warnings;
  EXPECT_NEAR(load_environment(folder / "sky.png", warnings).map->at(1, 1).x, 0.5029F, 1e-3);
}

TEST(EnvironmentFile, ConvertsFromThePrimariesThatTheFileNames) {
  const TemporaryFolder folder;
  Image image = grey_image(4, 2, 1);
  image.at(0, 0)[1] = image.at(0, 0)[2] = 0;
  // ACEScg. Its white is Rec.709's; its red is 1.705, -0.130, -0.024 there (matrix of the ACES documents).
  const Attributes attributes{
      {"chromaticities", std::array<float, 8>{0.713F, 0.293F, 0.165F, 0.830F, 0.128F, 0.044F, 0.32168F, 0.33767F}}};
  save_image(image, folder / "sky.exr", PixelType::kFloat, attributes);
  std::vector<std::string> warnings;
  const EnvironmentLight light = load_environment(folder / "sky.exr", warnings);
  EXPECT_NEAR(light.map->at(1, 1).x, 1, 1e-3);
  EXPECT_NEAR(light.map->at(1, 1).z, 1, 1e-3);
  EXPECT_NEAR(light.map->at(0, 0).x, 1.705F, 2e-3);
  EXPECT_EQ(light.map->at(0, 0).y, 0);  // what Rec.709 would need less than nothing of
  EXPECT_TRUE(warnings.empty());
}

TEST(EnvironmentFile, ConvertsFromTheSpaceThatTheFileNames) {
  const TemporaryFolder folder;
  Image image = grey_image(4, 2, 1);
  image.at(0, 0)[0] = 0.9505F;  // the white of D65
  image.at(0, 0)[2] = 1.0888F;
  save_image(image, folder / "sky.exr", PixelType::kFloat, {{"chiaro:color_space", "CIE-XYZ-D65"}});
  const auto path = folder.write("lights.json", R"({"lights":[{"type":"environment","image":"sky.exr"}]})");
  std::vector<std::string> warnings;
  const Lights lights = load_lights(path, warnings, CHIARO_SOURCE_DIR "/scenes/color/config.ocio");
  const Vec3f white = std::get<EnvironmentLight>(lights.front()).map->at(0, 0);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 1, 1e-3);
}

TEST(EnvironmentFile, MendsPixelsThatAreNoLight) {
  const TemporaryFolder folder;
  Image image = grey_image(4, 2, 1);
  image.at(0, 0)[0] = kNotANumber;
  image.at(1, 0)[1] = kInfinity;
  image.at(2, 0)[2] = -5;
  save_image(image, folder / "sky.exr", PixelType::kFloat);
  std::vector<std::string> warnings;
  const EnvironmentLight light = load_environment(folder / "sky.exr", warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("3 pixels are negative, not finite or too bright"), std::string::npos) << warnings[0];
  EXPECT_EQ(light.map->at(0, 0), (Vec3f{0, 1, 1}));
  EXPECT_EQ(light.map->at(1, 0), (Vec3f{1, 65504, 1}));
  EXPECT_EQ(light.map->at(2, 0), (Vec3f{1, 1, 0}));
}

TEST(EnvironmentFile, RefusesWhatIsNone) {
  const TemporaryFolder folder;
  std::vector<std::string> warnings;
  const auto error = [&](const std::filesystem::path& path) {
    return error_of([&] { load_environment(path, warnings); });
  };
  save_image(grey_image(4, 2, 0), folder / "dark.exr", PixelType::kHalf);
  save_image(make_image(4, 2, {"Z", "id"}), folder / "depth.exr", PixelType::kHalf);
  EXPECT_NE(error(folder / "missing.exr").find("no such file"), std::string::npos);
  EXPECT_NE(error(folder.write("text.exr", "text")).find("text.exr"), std::string::npos);
  EXPECT_NE(error(folder / "dark.exr").find("are all black"), std::string::npos);
  EXPECT_NE(error(folder / "depth.exr").find("channels: are "), std::string::npos) << error(folder / "depth.exr");
}

TEST(EnvironmentFile, WarnsOfOtherShapes) {
  const TemporaryFolder folder;
  save_image(grey_image(4, 4, 1), folder / "square.exr", PixelType::kHalf);
  std::vector<std::string> warnings;
  load_environment(folder / "square.exr", warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("stretched"), std::string::npos);
}

TEST(LightFileEnvironment, ComesFromTheFilesOwnFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "skies");
  save_image(grey_image(4, 2, 2), folder / "skies/noon.exr", PixelType::kHalf);
  const auto path = folder.write(
      "lights.json", R"({"lights":[{"type":"environment","image":"skies/noon.exr","rotation":1.5,"intensity":3}]})");
  const Lights lights = load_lights(path);
  ASSERT_EQ(lights.size(), 1U);
  const auto& light = std::get<EnvironmentLight>(lights[0]);
  EXPECT_EQ(light.name, "environment");
  EXPECT_EQ(light.rotation, 1.5F);
  EXPECT_EQ(light.intensity, 3);
  EXPECT_EQ(light.map->at(0, 0).x, 2);
  // And back, but not to another folder, where the image would not be found, nor into glTF's lights.
  save_lights(lights, folder / "again.json");
  EXPECT_EQ(std::get<EnvironmentLight>(load_lights(folder / "again.json").at(0)).rotation, 1.5F);
  EXPECT_NE(error_of([&] {
              save_lights(lights, folder / "elsewhere/lights.json");
            }).find("no image in the light file's folder"),
            std::string::npos);
  const auto scene = folder.write("scene.glb", triangle_scene().glb());
  EXPECT_NE(error_of([&] { save_gltf_with_lights(scene, lights, folder / "lit.glb", {}); }).find("no environments"),
            std::string::npos);
}

struct BadEnvironment {
  const char* name;
  const char* fields;
  const char* expected;
};

class BadLightFileEnvironment : public testing::TestWithParam<BadEnvironment> {};

TEST_P(BadLightFileEnvironment, IsRefusedNamingTheField) {
  const TemporaryFolder folder;
  save_image(grey_image(4, 2, 2), folder / "sky.exr", PixelType::kHalf);
  const auto path =
      folder.write("lights.json", std::string(R"({"lights":[{"type":"environment",)") + GetParam().fields + "}]}");
  const std::string message = error_of([&] { load_lights(path); });
  EXPECT_NE(message.find(GetParam().expected), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadLightFileEnvironment,
    testing::Values(BadEnvironment{"NoImage", R"("intensity":1)", "lights[0].image: is missing"},
                    BadEnvironment{"NumberForImage", R"("image":3)", "lights[0].image: is of the wrong type"},
                    BadEnvironment{"AbsolutePath", R"("image":"/etc/passwd")", "outside the light file's folder"},
                    BadEnvironment{"Above", R"("image":"a/../../sky.exr")", "outside the light file's folder"},
                    BadEnvironment{"Missing", R"("image":"none.exr")", "none.exr: no such file"},
                    BadEnvironment{"Degrees", R"("image":"sky.exr","rotation":90)", "-2π to 2π radians"},
                    BadEnvironment{"Negative", R"("image":"sky.exr","intensity":-1)", "lights[0].intensity: is -1"}),
    test::kByName);

TEST(EnvironmentFile, PixelsBeyondAllMeasureAreMendedAndSampled) {
  const TemporaryFolder folder;
  save_image(grey_image(4, 2, 3e38F), folder / "sky.exr", PixelType::kFloat);
  std::vector<std::string> warnings;
  const EnvironmentLight light = load_environment(folder / "sky.exr", warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(light.map->at(1, 1).x, kBrightest);
}

}  // namespace
}  // namespace chiaro::renderer::tests

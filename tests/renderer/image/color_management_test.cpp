#include "renderer/image/color_management.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tests/renderer/io/gltf_builder.h"

namespace chiaro::renderer::tests {
namespace {

using renderer::Image;

// Scene-linear Rec.709 and ACEScg, an sRGB-like curve, and two displays.
constexpr const char* kConfig = R"(ocio_profile_version: 2
roles:
  default: lin_rec709
  scene_linear: lin_rec709
  rendering: acescg
displays:
  first:
    - !<View> {name: gamma, colorspace: gamma2}
    - !<View> {name: plain, colorspace: lin_rec709}
  second:
    - !<View> {name: plain, colorspace: lin_rec709}
active_displays: [first, second]
colorspaces:
  - !<ColorSpace>
    name: lin_rec709
    isdata: false
  - !<ColorSpace>
    name: gamma2
    isdata: false
    from_scene_reference: !<ExponentTransform> {value: 2, direction: inverse}
  - !<ColorSpace>
    name: acescg
    isdata: false
    to_scene_reference: !<MatrixTransform> {matrix: [1.70505154, -0.62179215, -0.08325932, 0, -0.13025700, 1.14080274, -0.01054830, 0, -0.02400337, -0.12896980, 1.15297345, 0, 0, 0, 0, 1]}
  - !<ColorSpace>
    name: odd
    isdata: false
    to_scene_reference: !<MatrixTransform> {matrix: [0.5, 0.5, 0, 0, 0.5, -0.5, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}
)";

// $OCIO and $CHIARO_DATA as they were, when the test ends.
class Environment {
 public:
  explicit Environment(const char* name) : name_(name) {
    if (const char* value = std::getenv(name)) value_ = value;
  }
  ~Environment() { value_ ? setenv(name_, value_->c_str(), 1) : unsetenv(name_); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::optional<std::string> value_;
};

Image one_pixel(const std::vector<std::string>& channels, const std::vector<float>& values) {
  Image image = renderer::make_image(1, 1, channels);
  image.pixels = values;
  return image;
}

TEST(ColorManagement, ADisplayViewIsAppliedAfterExposure) {
  const TemporaryFolder folder;
  const auto config = folder.write("config.ocio", kConfig);
  const Image image = one_pixel({"R", "G", "B", "A"}, {0.0625F, 0.25F, 100, 0.5F});
  const Image shown = renderer::apply_display_view(image, config, {});
  EXPECT_EQ(shown.channel_names, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_NEAR(shown.pixels[0], 0.25F, 1e-4F);
  EXPECT_NEAR(shown.pixels[1], 0.5F, 1e-4F);
  EXPECT_EQ(shown.pixels[2], 1) << "clamped";
  const Image brighter = renderer::apply_display_view(image, config, {"", "", 2});
  EXPECT_NEAR(brighter.pixels[0], 0.5F, 1e-4F);
  const Image plain = renderer::apply_display_view(image, config, {"second", "", 0});
  EXPECT_NEAR(plain.pixels[1], 0.25F, 1e-6F);
}

TEST(ColorManagement, EveryPixelOfALargeImageIsConverted) {
  const TemporaryFolder folder;
  const auto config = folder.write("config.ocio", kConfig);
  Image image = renderer::make_image(500, 300, {"R", "G", "B"});
  image.pixels.assign(image.pixels.size(), 0.25F);
  for (const float value : renderer::apply_display_view(image, config, {}).pixels) ASSERT_NEAR(value, 0.5F, 1e-4F);
}

TEST(ColorManagement, UnknownChoicesAreRefusedNamingThoseThereAre) {
  const TemporaryFolder folder;
  const auto config = folder.write("config.ocio", kConfig);
  Image image = one_pixel({"R", "G", "B"}, {1, 1, 1});
  const auto message = [&](const renderer::ViewOptions& options) {
    return error_of([&] { renderer::apply_display_view(image, config, options); });
  };
  EXPECT_NE(message({"third", "", 0}).find("first, second"), std::string::npos);
  EXPECT_NE(message({"", "odd", 0}).find("gamma, plain"), std::string::npos);
  const std::string space = error_of([&] { convert_from_rec709(image, config, "nowhere", {""}); });
  EXPECT_NE(space.find("lin_rec709, gamma2, acescg, odd"), std::string::npos) << space;
  EXPECT_NE(error_of([&] { renderer::chromaticities_of(config, "nowhere"); }), "");
}

TEST(ColorManagement, BrokenConfigsAreRefusedInOneLine) {
  const TemporaryFolder folder;
  const Image image = one_pixel({"R", "G", "B"}, {1, 1, 1});
  const std::string others =
      "ocio_profile_version: 1\nroles: {default: a}\ndisplays:\n  d:\n    - !<View> {name: v, "
      "colorspace: a}\ncolorspaces:\n  - !<ColorSpace> {name: a}\n";
  for (const std::string& text :
       {std::string(), std::string("not: [a config"), std::string("ocio_profile_version: 99\n"), others}) {
    const auto config = folder.write("config.ocio", text);
    const std::string message = error_of([&] { renderer::apply_display_view(image, config, {}); });
    EXPECT_NE(message.find("config.ocio"), std::string::npos) << text;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(ColorManagement, OnlyTheLayersNamedAreConverted) {
  const TemporaryFolder folder;
  const auto config = folder.write("config.ocio", kConfig);
  Image image = one_pixel({"R", "G", "B", "direct.R", "direct.G", "direct.B", "normal.R", "normal.G", "normal.B"},
                          {1, 1, 1, 1, 0, 0, 1, 0, 0});
  convert_from_rec709(image, config, "acescg", {"", "direct"});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.pixels[c], 1, 1e-4F) << "white stays white";
  EXPECT_NEAR(image.pixels[3], 0.6131F, 1e-3F);
  EXPECT_NEAR(image.pixels[4], 0.0702F, 1e-3F);
  EXPECT_EQ(image.pixels[6], 1) << "normals are no colours";
  EXPECT_EQ(image.pixels[7], 0);
}

TEST(ColorManagement, ChromaticitiesAreKnownForRgbSpacesInUse) {
  const TemporaryFolder folder;
  const auto config = folder.write("config.ocio", kConfig);
  const auto rec709 = renderer::chromaticities_of(config, "lin_rec709");
  ASSERT_TRUE(rec709.has_value());
  EXPECT_FLOAT_EQ((*rec709)[0], 0.64F);
  EXPECT_FLOAT_EQ((*rec709)[7], 0.329F);
  const auto aces = renderer::chromaticities_of(config, "rendering");
  ASSERT_TRUE(aces.has_value());
  EXPECT_FLOAT_EQ((*aces)[0], 0.713F);
  EXPECT_FLOAT_EQ((*aces)[6], 0.32168F);
  EXPECT_FALSE(renderer::chromaticities_of(config, "gamma2").has_value());
  EXPECT_FALSE(renderer::chromaticities_of(config, "odd").has_value());
}

TEST(ColorManagement, TheConfigIsTheExplicitOneElseTheEnvironments) {
  const TemporaryFolder folder, data;
  const Environment ocio("OCIO"), chiaro_data("CHIARO_DATA");
  const auto one = folder.write("one.ocio", kConfig), two = folder.write("two.ocio", kConfig);
  std::filesystem::create_directories(data / "color");
  const auto three = data.write("color/config.ocio", kConfig);
  setenv("OCIO", two.c_str(), 1);
  setenv("CHIARO_DATA", data.path().c_str(), 1);
  EXPECT_EQ(renderer::find_ocio_config(one), one);
  EXPECT_EQ(renderer::find_ocio_config({}), two);
  unsetenv("OCIO");
  EXPECT_TRUE(std::filesystem::equivalent(renderer::find_ocio_config({}), three));
  EXPECT_NE(error_of([&] { renderer::find_ocio_config(folder / "no.ocio"); }).find("no.ocio"), std::string::npos);
  setenv("OCIO", "/nowhere/config.ocio", 1);
  EXPECT_NE(error_of([] { renderer::find_ocio_config({}); }).find("$OCIO"), std::string::npos);
}

}  // namespace
}  // namespace chiaro::renderer::tests

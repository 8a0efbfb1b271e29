#include "renderer/image/color_management.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

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

// Works in ACEScg, and has Rec.709 by no name; only its interchange role says where colours are.
constexpr const char* kAcesConfig = R"(ocio_profile_version: 2
roles:
  default: work
  scene_linear: work
  aces_interchange: exchange
displays:
  first:
    - !<View> {name: working, colorspace: work}
    - !<View> {name: graded, colorspace: work, looks: doubled}
    - !<View> {name: grey, colorspace: grey}
    - !<View> {name: clipped, colorspace: clipped}
looks:
  - !<Look> {name: doubled, process_space: work, transform: !<MatrixTransform> {matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}}
  - !<Look> {name: halved, process_space: work, transform: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}}
colorspaces:
  - !<ColorSpace> {name: exchange, isdata: false}
  - !<ColorSpace>
    name: work
    isdata: false
    to_scene_reference: !<BuiltinTransform> {style: ACEScg_to_ACES2065-1}
  - !<ColorSpace>
    name: grey
    isdata: false
    from_scene_reference: !<MatrixTransform> {matrix: [0.3, 0.3, 0.4, 0, 0.3, 0.3, 0.4, 0, 0.3, 0.3, 0.4, 0, 0, 0, 0, 1]}
  - !<ColorSpace>
    name: clipped
    isdata: false
    from_scene_reference: !<RangeTransform> {min_in_value: 0, max_in_value: 0.5, min_out_value: 0, max_out_value: 0.5}
  - !<ColorSpace> {name: data, isdata: true}
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

// Whatever the view's curves and matrices make of so much: it is white.
TEST(ColorManagement, TheBrightestIsWhite) {
  const std::filesystem::path config = CHIARO_SOURCE_DIR "/scenes/color/config.ocio";
  for (const float value : {1e3F, 1e12F, 1e24F, 3e38F, std::numeric_limits<float>::infinity()}) {
    const Image shown =
        renderer::apply_display_view(one_pixel({"R", "G", "B"}, {value, value, value}), config, {"", "", 70});
    for (const float channel : shown.pixels) EXPECT_GT(channel, 0.9F) << value;
  }
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
  const std::string look = message({"", "", 0, "warm"});
  EXPECT_NE(look.find("(expected none: the config has no look)"), std::string::npos) << look;
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

// A config whose default view is of "out", which is as told.
std::string config_of(const std::string& out, const std::string& more_spaces = "") {
  return "ocio_profile_version: 2\nroles: {default: lin_rec709, scene_linear: lin_rec709}\n"
         "displays:\n  screen:\n    - !<View> {name: v, colorspace: out}\ncolorspaces:\n"
         "  - !<ColorSpace> {name: lin_rec709}\n  - !<ColorSpace> {name: out, from_scene_reference: " +
         out + "}\n" + more_spaces;
}

std::string error_of_view(const std::string& config) {
  const TemporaryFolder folder;
  const auto path = folder.write("config.ocio", config);
  return error_of([&] { apply_display_view({1, 1, {"R", "G", "B"}, {0.5F, 0.5F, 0.5F}}, path, {}); });
}

// OpenColorIO follows them until its stack or somebody's patience ends.
TEST(ColorManagement, ConfigsThatReferToThemselvesAreRefused) {
  const auto to = [](const std::string& space) {
    return "!<ColorSpaceTransform> {src: lin_rec709, dst: " + space + "}";
  };
  const auto space = [](const std::string& name, const std::string& transform) {
    return "  - !<ColorSpace> {name: " + name + ", from_scene_reference: " + transform + "}\n";
  };
  const std::string gamma = "!<ExponentTransform> {value: 2}";
  EXPECT_EQ(error_of_view(config_of(to("a"), space("a", gamma))), "");
  EXPECT_NE(error_of_view(config_of(to("out"))).find("colour space \"out\": refers to itself"), std::string::npos);
  EXPECT_NE(error_of_view(config_of(to("a"), space("a", to("out")))).find("refers to itself"), std::string::npos);
  EXPECT_NE(error_of_view(config_of(gamma, space("a", to("a")))).find("colour space \"a\": refers to itself"),
            std::string::npos)
      << "though nothing uses it";
  EXPECT_NE(error_of_view("looks:\n  - !<Look> {name: l, process_space: lin_rec709, transform: !<LookTransform> {src: "
                          "lin_rec709, dst: lin_rec709, looks: l}}\n" +
                          config_of(gamma))
                .find("look \"l\": refers to itself"),
            std::string::npos);
  for (const std::string name : {"my look", "a-b"}) {
    const std::string look = "looks:\n  - !<Look> {name: " + name + ", process_space: out, transform: " + gamma + "}\n";
    const std::string uses = "!<LookTransform> {src: lin_rec709, dst: lin_rec709, looks: \"+ " + name + "\"}";
    EXPECT_NE(error_of_view(look + config_of(uses)).find("refers to itself"), std::string::npos) << name;
  }
  const std::string through_default_view =
      "view_transforms:\n  - !<ViewTransform> {name: vt, from_scene_reference: " + to("shown") +
      "}\ndisplay_colorspaces:\n  - !<ColorSpace> {name: shown, from_display_reference: " + gamma + "}\n";
  EXPECT_NE(
      error_of_view(through_default_view + config_of(to("shown"))).find("view transform \"vt\": refers to itself"),
      std::string::npos);
  std::string fan, chain;
  for (int i = 0; i < 20; ++i) {
    const std::string next = to("f" + std::to_string(i + 1));
    fan += space("f" + std::to_string(i), "!<GroupTransform> {children: [" + next + ", " + next + "]}");
  }
  EXPECT_NE(error_of_view(config_of(to("f0"), fan + space("f20", gamma))).find("asks for more transforms"),
            std::string::npos);
  for (int i = 100; i > 0; --i)
    chain += space("c" + std::to_string(i), i == 100 ? gamma : to("c" + std::to_string(i + 1)));
  EXPECT_NE(error_of_view(config_of(to("c1"), chain)).find("refers to others"), std::string::npos);
}

TEST(ColorManagement, ConfigsThatRepeatThemselvesWithoutMeasureAreRefused) {
  std::string spaces = "  - !<ColorSpace> {name: z0, from_scene_reference: &a0 !<ExponentTransform> {value: 1.01}}\n";
  for (int i = 1; i < 9; ++i) {
    const std::string alias = "*a" + std::to_string(i - 1), number = std::to_string(i);
    spaces += "  - !<ColorSpace> {name: z" + number + ", from_scene_reference: &a" + number +
              " !<GroupTransform> {children: [" + alias + ", " + alias + ", " + alias + "]}}\n";
  }
  EXPECT_NE(error_of_view(config_of("!<ExponentTransform> {value: 2}", spaces)).find("repeats parts of itself"),
            std::string::npos);
  std::string many;
  for (int i = 0; i < 100; ++i) {
    many += "  - !<ColorSpace> {name: s" + std::to_string(i) +
            ", from_scene_reference: " + (i == 0 ? "&curve !<ExponentTransform> {value: 2}" : "*curve") + "}\n";
  }
  EXPECT_EQ(error_of_view(config_of("!<ExponentTransform> {value: 2}", many)), "") << "many of one that has none";
}

TEST(ColorManagement, TablesInPipesAndDevicesAreRefused) {
  EXPECT_NE(error_of_view("search_path: .\n" + config_of("!<FileTransform> {src: /dev/zero}"))
                .find("\"/dev/zero\": is not a file"),
            std::string::npos);
}

TEST(ColorManagement, NothingThatIsNotFiniteIsMadeOfWhatIs) {
  const TemporaryFolder folder;
  const std::string thousandfold =
      "!<MatrixTransform> {matrix: [1e3, 0, 0, 0, 0, 1e3, 0, 0, 0, 0, 1e3, 0, 0, 0, 0, 1]}";
  const auto config = folder.write("config.ocio", config_of(thousandfold));
  Image bright = one_pixel({"R", "G", "B"}, {1e30F, 1, 0}), brightest = one_pixel({"R", "G", "B"}, {1e36F, 1, 0});
  EXPECT_NO_THROW(convert_from_rec709(bright, config, "out", {}));
  EXPECT_NE(test::error_of([&] { convert_from_rec709(brightest, config, "out", {}); }).find("not finite"),
            std::string::npos);
}

TEST(ColorManagement, WhatMakesNoNumbersOfColoursIsRefused) {
  EXPECT_NE(error_of_view(config_of("!<MatrixTransform> {offset: [.nan, 0, 0, 0]}")).find("not finite"),
            std::string::npos);
}

// They are the config's words, escape sequences and all.
TEST(ColorManagement, WarningsOfOpenColorIoAreNotPassedOn) {
  testing::internal::CaptureStderr();
  error_of_view("unknown_key: 1\n" + config_of("!<ExponentTransform> {value: 2, unknown: 3}"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
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

// The values are those of Rec.709's red in AP1, by colour-science's RGB_to_RGB with the Bradford transform.
TEST(ColorManagement, ConfigsThatWorkInOtherPrimariesGetTheirs) {
  const TemporaryFolder folder;
  const auto config = folder.write("config.ocio", kAcesConfig);
  Image image = one_pixel({"R", "G", "B"}, {1, 0, 0});
  const Image shown = renderer::apply_display_view(image, config, {});
  const float expected[3] = {0.6131F, 0.0702F, 0.0206F};
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(shown.pixels[c], expected[c], 2e-4F);
  convert_from_rec709(image, config, "scene_linear", {""});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.pixels[c], expected[c], 2e-4F);
  convert_to_rec709(image, config, "scene_linear");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.pixels[c], c == 0 ? 1 : 0, 1e-5F);
  const auto chromaticities = renderer::chromaticities_of(config, "scene_linear");
  ASSERT_TRUE(chromaticities.has_value());
  EXPECT_FLOAT_EQ((*chromaticities)[0], 0.713F);
}

TEST(ColorManagement, ALookTakesThePlaceOfTheViews) {
  const TemporaryFolder folder;
  const auto config = folder.write("config.ocio", kAcesConfig);
  const Image image = one_pixel({"R", "G", "B"}, {0.25F, 0.25F, 0.25F});
  const auto shown = [&](const char* look) {
    return renderer::apply_display_view(image, config, {"", "graded", 0, look}).pixels[1];
  };
  EXPECT_NEAR(shown(""), 0.5F, 1e-4F);
  EXPECT_NEAR(shown("none"), 0.25F, 1e-4F);
  EXPECT_NEAR(shown("halved"), 0.125F, 1e-4F);
  EXPECT_NE(error_of([&] { shown("other"); }).find("doubled, halved"), std::string::npos);
}

TEST(ColorManagement, ANamedSpaceBecomesRec709) {
  const TemporaryFolder folder;
  const auto config = folder.write("config.ocio", kConfig);
  Image image = one_pixel({"R", "G", "B", "A"}, {0.5F, 0.25F, 1, 0.5F});
  convert_to_rec709(image, config, "gamma2");
  EXPECT_NEAR(image.pixels[0], 0.25F, 1e-4F);
  EXPECT_NEAR(image.pixels[1], 0.0625F, 1e-4F);
  EXPECT_EQ(image.pixels[3], 0.5F) << "alpha is no colour";
  EXPECT_NE(error_of([&] { convert_to_rec709(image, config, "nowhere"); }).find("gamma2"), std::string::npos);
  Image grey = one_pixel({"Y"}, {1});
  EXPECT_NE(error_of([&] { convert_to_rec709(grey, config, "gamma2"); }), "");
}

TEST(ColorManagement, SpacesInWhichLightAddsUpAreToldByTheirValues) {
  const TemporaryFolder folder;
  const auto config = folder.write("config.ocio", kConfig);
  for (const char* linear : {"lin_rec709", "acescg", "odd", "rendering"}) {
    EXPECT_NO_THROW(renderer::require_linear_space(config, linear)) << linear;
  }
  const std::string gamma = error_of([&] { renderer::require_linear_space(config, "gamma2"); });
  EXPECT_NE(gamma.find("\"gamma2\" is not scene-linear (expected one of lin_rec709, acescg, odd)"), std::string::npos)
      << gamma;
  EXPECT_NE(error_of([&] { renderer::require_linear_space(config, "nowhere"); }).find("gamma2"), std::string::npos);
  const auto aces = folder.write("aces.ocio", kAcesConfig);
  EXPECT_NE(error_of([&] { renderer::require_linear_space(aces, "clipped"); }).find("exchange, work, grey, data"),
            std::string::npos);
}

TEST(ColorManagement, OurLinearSpacesAreLinear) {
  const std::filesystem::path config = CHIARO_SOURCE_DIR "/scenes/color/config.ocio";
  for (const char* linear : {"ACES2065-1", "ACEScg", "CIE-XYZ-D65", "Linear Rec.709 (sRGB)", "scene_linear", "Raw"}) {
    EXPECT_NO_THROW(renderer::require_linear_space(config, linear)) << linear;
  }
  for (const char* other : {"ACEScct", "sRGB - Texture", "sRGB - Display", "Rec.1886 Rec.709 - Display"}) {
    EXPECT_NE(error_of([&] { renderer::require_linear_space(config, other); }), "") << other;
  }
}

TEST(ColorManagement, DataIsNeverConverted) {
  const TemporaryFolder folder;
  const auto config = folder.write("config.ocio", kAcesConfig);
  Image image = one_pixel({"R", "G", "B"}, {0.5F, 0.25F, 0});
  convert_to_rec709(image, config, "data");
  EXPECT_EQ(image.pixels, (std::vector<float>{0.5F, 0.25F, 0}));
}

// Colours that the views clip nowhere.
Image some_colors() {
  Image image = renderer::make_image(6, 6, {"R", "G", "B", "A"});
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 6; ++x) {
      const float color[4] = {0.1F + 0.05F * float(x), 0.1F + 0.05F * float(y), 0.15F + 0.02F * float(x + y), 0.5F};
      std::copy(color, color + 4, image.at(x, y));
    }
  }
  return image;
}

void expect_view_inverts(const std::filesystem::path& config, const renderer::ViewOptions& options) {
  const Image image = some_colors();
  Image shown = renderer::make_image(image.width, image.height, image.channel_names);
  const Image colors = renderer::apply_display_view(image, config, options);
  for (int i = 0; i < 36; ++i) {
    std::copy(&colors.pixels[3 * i], &colors.pixels[3 * i] + 3, &shown.pixels[4 * i]);
    shown.pixels[4 * i + 3] = image.pixels[4 * i + 3];
  }
  const Image again = renderer::to_rec709_from_display_view(shown, config, options);
  EXPECT_EQ(again.channel_names, image.channel_names);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    ASSERT_NEAR(again.pixels[i], image.pixels[i], 1e-3F) << options.view << " " << i;
  }
}

TEST(ColorManagement, ViewsAreUndone) {
  const TemporaryFolder folder;
  const auto gamma = folder.write("gamma.ocio", kConfig), aces = folder.write("aces.ocio", kAcesConfig);
  expect_view_inverts(gamma, {"", "", 0.5F});
  expect_view_inverts(aces, {"", "working", 0});
  expect_view_inverts(aces, {"", "graded", -1});
  expect_view_inverts(aces, {"", "working", 1, "halved"});
  const auto ours = std::filesystem::path(CHIARO_SOURCE_DIR) / "scenes/color/config.ocio";
  for (const char* display : {"sRGB", "Rec.1886"}) {
    for (const char* view : {"ACES 1.0 - SDR Video", "Un-tone-mapped", "Raw"}) {
      expect_view_inverts(ours, {display, view, -1});
    }
  }
}

TEST(ColorManagement, ViewsThatCannotBeUndoneAreRefused) {
  const TemporaryFolder folder;
  const auto config = folder.write("config.ocio", kAcesConfig);
  for (const char* view : {"grey", "clipped"}) {
    const std::string message = error_of([&] {
      renderer::to_rec709_from_display_view(some_colors(), config, {"", view, 0});
    });
    EXPECT_NE(message.find("config.ocio"), std::string::npos) << message;
    EXPECT_NE(message.find(std::string("\"") + view + "\" has no inverse"), std::string::npos) << message;
  }
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

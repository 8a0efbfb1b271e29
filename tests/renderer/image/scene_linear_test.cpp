#include "renderer/image/scene_linear.h"

#include <gtest/gtest.h>

#include "renderer/core/error.h"
#include "tests/support/error_of.h"

namespace chiaro::renderer {
namespace {

constexpr std::array<float, 8> kRec709{0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F};
constexpr std::array<float, 8> kRec2020{0.708F, 0.292F, 0.170F, 0.797F, 0.131F, 0.046F, 0.3127F, 0.3290F};

ImageFile file_of(Image image, Attributes attributes = {}) {
  ImageFile file;
  file.image = std::move(image);
  file.attributes = std::move(attributes);
  return file;
}

TEST(SceneLinear, DepthIsNoColor) {
  EXPECT_EQ(scene_linear_rec709(file_of(Image{1, 1, {"Y"}, {3}}), "x.exr").front(), (Vec3f{3, 3, 3}));
  for (const char* name : {"Z", "A", "depth", "ViewLayer.Depth"}) {
    EXPECT_NE(test::error_of([&] { scene_linear_rec709(file_of(Image{1, 1, {name}, {3}}), "x.exr"); }), "") << name;
  }
}

TEST(SceneLinear, OtherPrimariesAreKnownAndConverted) {
  const Image green{1, 1, {"R", "G", "B"}, {0, 1, 0}};
  EXPECT_FALSE(has_other_primaries(file_of(green), "x.exr"));
  EXPECT_FALSE(has_other_primaries(file_of(green, {{"chromaticities", kRec709}}), "x.exr"));
  const ImageFile wide = file_of(green, {{"chromaticities", kRec2020}});
  EXPECT_TRUE(has_other_primaries(wide, "x.exr"));
  // ITU-R BT.2087, the inverse of its matrix M2.
  const Vec3f found = scene_linear_rec709(wide, "x.exr").front();
  EXPECT_NEAR(found.x, -0.5876F, 1e-3F);
  EXPECT_NEAR(found.y, 1.1329F, 1e-3F);
  EXPECT_NEAR(found.z, -0.1006F, 1e-3F);
}

TEST(SceneLinear, PrimariesThatSpanNextToNoColorsAreRefused) {
  const Image green{1, 1, {"R", "G", "B"}, {0, 1, 0}};
  for (const float apart : {0.0F, 1e-6F}) {
    const std::array<float, 8> flat{0.64F, 0.33F, 0.64F + apart, 0.33F, 0.15F, 0.06F, 0.3127F, 0.3290F};
    EXPECT_EQ(test::error_of([&] {
                has_other_primaries(file_of(green, {{"chromaticities", flat}}), "x.exr");
              }),
              "x.exr: chromaticities: span no colours (expected three primaries and a white)");
  }
}

const std::string kConfig = CHIARO_SOURCE_DIR "/scenes/color/config.ocio";

// The white of D65 (IEC 61966-2-1) is that of Rec.709.
TEST(SceneLinear, TheNamedSpaceIsConverted) {
  const Image white{1, 1, {"A", "B", "G", "R"}, {1, 1.0888F, 1, 0.9505F}};
  const ImageFile file = file_of(white, {{kColorSpaceAttribute, "CIE-XYZ-D65"}});
  EXPECT_EQ(named_space(file), "CIE-XYZ-D65");
  const Vec3f found = scene_linear_rec709(file, "x.exr", kConfig).front();
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], 1, 1e-3F);
}

TEST(SceneLinear, ChromaticitiesAndWholeNumbersAreStrongerThanTheNamedSpace) {
  const Image green{1, 1, {"R", "G", "B"}, {0, 1, 0}};
  ImageFile file = file_of(green, {{kColorSpaceAttribute, "CIE-XYZ-D65"}, {"chromaticities", kRec709}});
  EXPECT_EQ(named_space(file), "");
  EXPECT_NEAR(scene_linear_rec709(file, "x.exr", kConfig).front().y, 1, 1e-3F);
  file.attributes.pop_back();
  file.whole_numbers = true;
  EXPECT_EQ(named_space(file), "");
}

TEST(SceneLinear, ASpaceThatIsNotKnownIsRefused) {
  const ImageFile file = file_of({1, 1, {"R", "G", "B"}, {0, 1, 0}}, {{kColorSpaceAttribute, "Arri"}});
  const std::string missing = test::error_of([&] { scene_linear_rec709(file, "x.exr", kConfig); });
  EXPECT_TRUE(missing.starts_with("x.exr: chiaro:color_space: is \"Arri\", but ")) << missing;
  EXPECT_NE(missing.find("--ocio or $OCIO"), std::string::npos) << missing;
}

TEST(SceneLinear, StoredColorsAreRedGreenAndBlue) {
  const Image found = stored_colors({1, 1, {"A", "B", "G", "R"}, {9, 3, 2, 1}}, "x.exr");
  EXPECT_EQ(found.channel_names, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(found.pixels, (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(stored_colors({1, 1, {"Y", "A"}, {4, 1}}, "x.png").pixels, (std::vector<float>{4, 4, 4}));
  EXPECT_THROW(stored_colors({1, 1, {"X", "Z"}, {4, 1}}, "x.exr"), Error);
}

}  // namespace
}  // namespace chiaro::renderer

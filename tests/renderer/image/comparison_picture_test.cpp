#include "renderer/image/comparison_picture.h"

#include <limits>

#include <gtest/gtest.h>

#include "renderer/image/heat_map.h"
#include "renderer/image/small_text.h"

namespace chiaro::renderer {
namespace {

Image constant(int width, int height, const std::vector<std::string>& channels, float value) {
  Image image = make_image(width, height, channels);
  image.pixels.assign(image.pixels.size(), value);
  return image;
}

std::vector<float> pixel(const Image& image, int x, int y) { return {image.at(x, y), image.at(x, y) + 3}; }

TEST(ComparisonPicture, TheDifferenceIsEightfold) {
  const Image a{2, 1, {"R", "G", "B"}, {0.5F, 0.25F, 0, 1, 1, 0}};
  const Image b{2, 1, {"R", "G", "B"}, {0.5F, 0.3125F, 1, 1, std::numeric_limits<float>::quiet_NaN(), 0.0625F}};
  EXPECT_EQ(magnified_difference(a, b).pixels, (std::vector<float>{0, 0.5F, 8, 0, 1, 0.5F}));
}

TEST(ComparisonPicture, HoldsAllFourWithTheirNames) {
  const std::vector<std::string> rgb{"R", "G", "B"};
  const ComparisonPanels panels{constant(100, 20, rgb, 0.1F), constant(100, 20, rgb, 0.2F),
                                constant(100, 20, rgb, 0.3F), constant(100, 20, {"FLIP"}, 0.75F)};
  const Image picture = comparison_picture(panels);
  ASSERT_EQ(picture.width, 200);
  const int caption = picture.height / 2 - 20;
  ASSERT_GE(caption, kTextHeight);
  EXPECT_EQ(pixel(picture, 0, 0), std::vector<float>(3, 0.1F));
  EXPECT_EQ(pixel(picture, 199, 19), std::vector<float>(3, 0.2F));
  EXPECT_EQ(pixel(picture, 0, caption + 20), std::vector<float>(3, 0.3F));
  const Vec3f hot = heat_color(0.75F);
  EXPECT_EQ(pixel(picture, 199, caption + 39), (std::vector<float>{hot.x, hot.y, hot.z}));
  for (const int row : {0, 1}) {
    for (const int column : {0, 1}) {
      float brightest = 0;
      for (int y = 20; y < 20 + caption; ++y) {
        for (int x = 0; x < 12; ++x) {
          brightest = std::max(brightest, *picture.at(100 * column + x, row * (20 + caption) + y));
        }
      }
      EXPECT_EQ(brightest, 1) << "a name under panel " << column << ", " << row;
    }
  }
}

TEST(ComparisonPicture, WithoutFlipAndOfASinglePixelIsAPictureToo) {
  const Image one = constant(1, 1, {"R", "G", "B"}, 0.5F);
  EXPECT_EQ(comparison_picture({one, one, one, {}}).width, 2);
  EXPECT_EQ(comparison_picture({one, one, one, constant(1, 1, {"FLIP"}, 0)}).width, 2);
}

TEST(HeatMap, BecomesLighterEvenly) {
  float before = -1;
  for (int i = 0; i <= 100; ++i) {
    const Vec3f color = heat_color(float(i) / 100);
    const float lightness = 0.2126F * color.x + 0.7152F * color.y + 0.0722F * color.z;
    EXPECT_GE(lightness, before - 2e-3F) << i;
    before = lightness;
  }
  EXPECT_LT(max_component(heat_color(0)), 0.05F);
  EXPECT_GT(min_component(heat_color(1)), 0.7F);
  EXPECT_EQ(heat_color(-1), heat_color(0));
  EXPECT_EQ(heat_color(7), heat_color(1));
  EXPECT_EQ(heat_color(std::numeric_limits<float>::quiet_NaN()), heat_color(0));
}

}  // namespace
}  // namespace chiaro::renderer

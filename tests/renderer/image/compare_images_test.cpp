#include "renderer/image/compare_images.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "renderer/core/error.h"

namespace chiaro::renderer {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Image make_rgb(int width, int height, std::vector<float> pixels) {
  return {width, height, {"R", "G", "B"}, std::move(pixels)};
}

TEST(CompareImages, FiguresAreTheHandComputedOnes) {
  const Image b = make_rgb(2, 2, {1, 1, 1, 2, 2, 2, 0, 0, 0, 1, 1, 1});
  const Image a = make_rgb(2, 2, {1, 1, 1, 2, 2, 2, 0, 0.5F, 0, 1, 3, 1});
  const ImageComparison found = compare_images(a, b);
  // Squared differences 0.25 and 4; Σ b² = 3 + 12 + 3.
  EXPECT_DOUBLE_EQ(found.relative_l2, std::sqrt(4.25 / 18));
  EXPECT_DOUBLE_EQ(found.rmse, std::sqrt(4.25 / 12));
  EXPECT_DOUBLE_EQ(found.relative_mse, (0.25 / 0.0001 + 4 / 1.0001) / 12);
  EXPECT_NEAR(found.psnr, 10 * std::log10(4 / (4.25 / 12)), 1e-12);
  EXPECT_DOUBLE_EQ(found.mean_a[0], 1);
  EXPECT_DOUBLE_EQ(found.mean_a[1], 6.5 / 4);
  EXPECT_DOUBLE_EQ(found.mean_b[2], 1);
  EXPECT_EQ(found.max_difference, 2);
  EXPECT_EQ(found.max_x, 1);
  EXPECT_EQ(found.max_y, 1);
  EXPECT_EQ(found.not_finite, 0U);
}

TEST(CompareImages, PixelsThatAreNotFiniteInEitherAreLeftOutAndCounted) {
  const Image b = make_rgb(3, 1, {1, 1, 1, 5, 5, 5, 7, kNan, 7});
  const Image a = make_rgb(3, 1, {2, 1, 1, 5, 5, std::numeric_limits<float>::infinity(), 7, 7, 7});
  const ImageComparison found = compare_images(a, b);
  EXPECT_EQ(found.not_finite, 2U);
  EXPECT_DOUBLE_EQ(found.relative_l2, std::sqrt(1.0 / 3));
  EXPECT_DOUBLE_EQ(found.rmse, std::sqrt(1.0 / 3));
  EXPECT_EQ(found.mean_a[0], 2);
  EXPECT_NEAR(found.psnr, 10 * std::log10(3.0), 1e-12);  // the peak, too, is of finite pixels
  EXPECT_EQ(found.max_x, 0);
}

TEST(CompareImages, EqualFramesDifferByNothing) {
  const Image image = make_rgb(1, 2, {1, 2, 3, 0, 0, 0});
  const ImageComparison found = compare_images(image, image);
  EXPECT_EQ(found.relative_l2, 0);
  EXPECT_EQ(found.rmse, 0);
  EXPECT_EQ(found.relative_mse, 0);
  EXPECT_EQ(found.max_difference, 0);
  EXPECT_TRUE(std::isinf(found.psnr) && found.psnr > 0);
}

TEST(CompareImages, BlackFramesGiveNoNan) {
  const Image black = make_rgb(1, 1, {0, 0, 0}), grey = make_rgb(1, 1, {1, 1, 1});
  EXPECT_EQ(compare_images(black, black).relative_l2, 0);
  EXPECT_FALSE(std::isnan(compare_images(black, black).psnr));
  EXPECT_TRUE(std::isinf(compare_images(grey, black).relative_l2));
  EXPECT_FALSE(std::isnan(compare_images(grey, black).psnr));
}

TEST(CompareImages, OtherChannelsAndTheirOrderDoNotMatter) {
  const Image a = make_rgb(1, 1, {1, 2, 3});
  const Image b{1, 1, {"A", "B", "G", "R", "albedo.R"}, {kNan, 3, 2, 1, 9}};
  const ImageComparison found = compare_images(a, b);
  EXPECT_EQ(found.relative_l2, 0);
  EXPECT_EQ(found.not_finite, 0U);
  EXPECT_EQ(found.mean_b, found.mean_a);
}

TEST(CompareImages, ASingleChannelCountsAsGrey) {
  const Image grey{1, 1, {"Y"}, {2}};
  const ImageComparison found = compare_images(make_rgb(1, 1, {2, 2, 3}), grey);
  EXPECT_DOUBLE_EQ(found.relative_l2, std::sqrt(1.0 / 12));
  EXPECT_EQ(found.mean_b[2], 2);
}

TEST(CompareImages, PicturesThatCannotBeComparedAreErrors) {
  const Image image = make_rgb(2, 1, {1, 2, 3, 4, 5, 6});
  EXPECT_THROW(compare_images(image, make_rgb(1, 2, {1, 2, 3, 4, 5, 6})), Error);
  EXPECT_THROW(comparison_picture(image, make_rgb(1, 1, {1, 2, 3})), Error);
  EXPECT_THROW(compare_images(make_rgb(0, 0, {}), make_rgb(0, 0, {})), Error);
  EXPECT_THROW(compare_images(image, {2, 1, {"R", "G", "Z"}, {1, 2, 3, 4, 5, 6}}), Error);
  EXPECT_THROW(compare_images({2, 1, {"X", "Y"}, {1, 2, 3, 4}}, image), Error);
  const Image nothing = make_rgb(1, 1, {kNan, 0, 0});
  EXPECT_THROW(compare_images(nothing, nothing), Error);
}

TEST(ComparisonPicture, HoldsBothAndEightTimesTheirDifference) {
  const Image a = make_rgb(1, 2, {0.5F, 0.25F, 0, 1, 1, 0});
  const Image b = make_rgb(1, 2, {0.5F, 0.3125F, 1, 1, kNan, 0.0625F});
  const Image picture = comparison_picture(a, b);
  ASSERT_EQ(picture.width, 3);
  ASSERT_EQ(picture.height, 2);
  EXPECT_EQ(picture.channel_names, (std::vector<std::string>{"R", "G", "B"}));
  const auto pixel = [&](int x, int y) { return std::vector<float>(picture.at(x, y), picture.at(x, y) + 3); };
  EXPECT_EQ(pixel(0, 0), (std::vector<float>{0.5F, 0.25F, 0}));
  EXPECT_EQ(pixel(1, 0), (std::vector<float>{0.5F, 0.3125F, 1}));
  EXPECT_EQ(pixel(2, 0), (std::vector<float>{0, 0.5F, 1}));
  EXPECT_EQ(pixel(0, 1), (std::vector<float>{1, 1, 0}));
  EXPECT_EQ(pixel(2, 1), (std::vector<float>{0, 1, 0.5F}));
}

}  // namespace
}  // namespace chiaro::renderer

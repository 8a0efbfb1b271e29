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

TEST(CompareImages, WithoutFinitePixelsNothingIsKnown) {
  Image bad = make_image(2, 2, {"R", "G", "B"});
  const Image good = bad;
  for (float& value : bad.pixels) value = kNan;
  const ImageComparison found = compare_images(bad, good);
  EXPECT_EQ(found.not_finite, 4U);
  for (const double figure : {found.relative_l2, found.rmse, found.relative_mse, found.psnr, found.max_difference}) {
    EXPECT_TRUE(std::isnan(figure));
  }
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
  EXPECT_THROW(compare_images(make_rgb(0, 0, {}), make_rgb(0, 0, {})), Error);
  EXPECT_THROW(compare_images(image, {2, 1, {"R", "G", "Z"}, {1, 2, 3, 4, 5, 6}}), Error);
  EXPECT_THROW(compare_images({2, 1, {"X", "Y"}, {1, 2, 3, 4}}, image), Error);
}

TEST(CompareImages, EachChannelHasItsFigures) {
  const Image b = make_rgb(2, 1, {1, 2, 3, 1, 2, 3});
  const Image a = make_rgb(2, 1, {1, 2, 4, 1, 3, 5});
  const ImageComparison found = compare_images(a, b);
  EXPECT_EQ(found.channels[0].relative_l2, 0);
  EXPECT_DOUBLE_EQ(found.channels[1].relative_l2, std::sqrt(1.0 / 8));
  EXPECT_DOUBLE_EQ(found.channels[2].rmse, std::sqrt(5.0 / 2));
  EXPECT_NEAR(found.channels[2].psnr, 10 * std::log10(9 / 2.5), 1e-12);
  EXPECT_EQ(found.channels[2].max_difference, 2);
  EXPECT_EQ(found.channels[2].mean_a, 4.5);
  EXPECT_EQ(found.channels[1].mean_b, 2);
}

TEST(CompareImages, ARegionIsComparedAlone) {
  const Image b = make_rgb(3, 2, std::vector<float>(18, 1));
  Image a = b;
  a.at(2, 1)[0] = 3;
  EXPECT_EQ(compare_images(a, b, {.region = PixelRegion{0, 0, 2, 2}, .peak = {}}).rmse, 0);
  const ImageComparison found = compare_images(a, b, {.region = PixelRegion{1, 1, 3, 2}, .peak = {}});
  EXPECT_DOUBLE_EQ(found.rmse, std::sqrt(4.0 / 6));
  EXPECT_EQ(found.max_x, 2);
  EXPECT_EQ(found.max_y, 1);
  for (const PixelRegion bad : {PixelRegion{0, 0, 4, 2}, PixelRegion{-1, 0, 2, 2}, PixelRegion{1, 1, 1, 2}}) {
    EXPECT_THROW(compare_images(a, b, {.region = bad, .peak = {}}), Error);
  }
}

TEST(CompareImages, ThePeakOfThePsnrMayBeGiven) {
  const Image b = make_rgb(1, 1, {0.5F, 0.5F, 0.5F}), a = make_rgb(1, 1, {0.6F, 0.5F, 0.5F});
  EXPECT_NEAR(compare_images(a, b, {.region = {}, .peak = 1}).psnr, 10 * std::log10(3 / 0.01), 1e-5);
}

TEST(MeanValue, IsOfTheFinitePixelsOfARegion) {
  const Image values{2, 2, {"FLIP"}, {1, 2, kNan, 4}};
  EXPECT_DOUBLE_EQ(mean_value(values), 7.0 / 3);
  EXPECT_DOUBLE_EQ(mean_value(values, PixelRegion{0, 1, 2, 2}), 4);
}

}  // namespace
}  // namespace chiaro::renderer

#include "renderer/image/resize.h"

#include <limits>

#include <gtest/gtest.h>

namespace chiaro::renderer {
namespace {

Image ramp(int width, int height) {
  Image image = make_image(width, height, {"R", "G"});
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at(x, y)[0] = (float(x) + 0.5F) / float(width);
      image.at(x, y)[1] = (float(y) + 0.5F) / float(height);
    }
  }
  return image;
}

TEST(Resize, TheSameSizeIsTheSameImage) {
  const Image image = ramp(5, 3);
  EXPECT_EQ(resize(image, 5, 3).pixels, image.pixels);
}

TEST(Resize, RampsStayRampsAwayFromTheBorder) {
  for (const auto& [width, height] : {std::pair{40, 30}, std::pair{10, 8}, std::pair{23, 17}}) {
    const Image found = resize(ramp(20, 16), width, height), wanted = ramp(width, height);
    for (int y = 2; y < height - 2; ++y) {
      for (int x = 2; x < width - 2; ++x) {
        for (int c = 0; c < 2; ++c) ASSERT_NEAR(found.at(x, y)[c], wanted.at(x, y)[c], 1e-5) << width;
      }
    }
  }
}

TEST(Resize, PixelsThatAreNotFiniteSpreadNoFartherThanTheyWeigh) {
  Image image = make_image(8, 8, {"Y"});
  *image.at(3, 4) = std::numeric_limits<float>::infinity();
  const Image tall = resize(image, 8, 16);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 8; ++x) {
      if (x != 3) {
        EXPECT_EQ(*tall.at(x, y), 0) << x << ' ' << y;
      }
    }
  }
}

TEST(Resize, ShrinkingAveragesAllPixels) {
  Image image = make_image(8, 8, {"Y"});
  *image.at(3, 4) = 64;
  const Image half = resize(image, 4, 4);
  float sum = 0;
  for (const float value : half.pixels) sum += value;
  EXPECT_NEAR(sum, 16, 1e-4);
}

}  // namespace
}  // namespace chiaro::renderer

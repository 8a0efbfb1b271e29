#include "renderer/image/image_orientation.h"

#include <gtest/gtest.h>

#include <array>

namespace chiaro::renderer {
namespace {

// TIFF 6.0, page 36: what the stored first row and first column are of the picture. This one is, as seen,
//   1 2 3
//   4 5 6
TEST(ImageOrientation, AllEightShowTheSamePicture) {
  struct Stored {
    int width, height;
    std::array<float, 6> pixels;
  };
  const Stored stored[] = {{3, 2, {1, 2, 3, 4, 5, 6}}, {3, 2, {3, 2, 1, 6, 5, 4}},   // top left, top right
                           {3, 2, {6, 5, 4, 3, 2, 1}}, {3, 2, {4, 5, 6, 1, 2, 3}},   // bottom right, bottom left
                           {2, 3, {1, 4, 2, 5, 3, 6}}, {2, 3, {3, 6, 2, 5, 1, 4}},   // left top, right top …
                           {2, 3, {6, 3, 5, 2, 4, 1}}, {2, 3, {4, 1, 5, 2, 6, 3}}};  // right bottom, left bottom
  for (int orientation = 1; orientation <= 8; ++orientation) {
    const Stored& from = stored[orientation - 1];
    Image image = make_image(from.width, from.height, {"Y"});
    image.pixels.assign(from.pixels.begin(), from.pixels.end());
    const Image seen = upright(image, orientation);
    EXPECT_EQ(is_turned(orientation), from.width == 2) << orientation;
    EXPECT_EQ(seen.width, 3) << orientation;
    EXPECT_EQ(seen.pixels, (std::vector<float>{1, 2, 3, 4, 5, 6})) << orientation;
  }
}

TEST(ImageOrientation, WhatIsNoneIsAsStored) {
  Image image = make_image(2, 1, {"Y"});
  image.pixels = {1, 2};
  for (const int orientation : {-1, 0, 9}) EXPECT_EQ(upright(image, orientation).pixels, image.pixels);
}

}  // namespace
}  // namespace chiaro::renderer

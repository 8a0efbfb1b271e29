#include "renderer/image/radiance_header.h"

#include <gtest/gtest.h>

#include "renderer/core/error.h"
#include "renderer/image/image_file.h"
#include "renderer/image/scene_linear.h"
#include "tests/renderer/io/gltf_builder.h"

namespace chiaro::renderer {
namespace {

using test::TemporaryFolder;

// One above the other: 1, 2, 4 and 8, 16, 32, as stored from the first scanline on.
std::string picture(const std::string& header, const std::string& size = "-Y 2 +X 1") {
  const char pixels[] = {'\x20', '\x40', '\x80', '\x83', '\x20', '\x40', '\x80', '\x86'};
  return "#?RADIANCE\n" + header + "FORMAT=32-bit_rle_rgbe\n\n" + size + "\n" + std::string(pixels, sizeof pixels);
}

std::vector<float> read(const TemporaryFolder& folder, const std::string& bytes) {
  return load_image(folder.write("a.hdr", bytes)).image.pixels;
}

TEST(RadianceHeader, PixelsAreWhatTheyWereBeforeTheyWereExposed) {
  const TemporaryFolder folder;
  EXPECT_EQ(read(folder, picture("")), (std::vector<float>{1, 2, 4, 8, 16, 32}));
  EXPECT_EQ(read(folder, picture("EXPOSURE=2\n")), (std::vector<float>{0.5F, 1, 2, 4, 8, 16}));
  EXPECT_EQ(read(folder, picture("EXPOSURE= 8\r\nCOLORCORR=1 2 4\nEXPOSURE=5.e-01\n")),
            (std::vector<float>{0.25F, 0.25F, 0.25F, 2, 2, 2}));
}

TEST(RadianceHeader, ThePictureIsSeenUpright) {
  const TemporaryFolder folder;
  EXPECT_EQ(read(folder, picture("", "+Y 2 +X 1")), (std::vector<float>{8, 16, 32, 1, 2, 4}));
}

// Radiance's file formats: the first axis is that of the lines, + is to the right and upwards.
TEST(RadianceHeader, ThePictureIsSeenUprightHoweverItIsStored) {
  const TemporaryFolder folder;
  constexpr int kWidth = 3, kHeight = 2;
  const auto coordinate = [](char sign, char axis, int i) {
    const int size = axis == 'X' ? kWidth : kHeight;
    return (axis == 'X') == (sign == '+') ? i : size - 1 - i;  // from the left, from the top
  };
  for (const std::string order : {"-Y+X", "-Y-X", "+Y-X", "+Y+X", "+X-Y", "+X+Y", "-X+Y", "-X-Y"}) {
    const int lines = order[1] == 'X' ? kWidth : kHeight, length = kWidth + kHeight - lines;
    std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + order.substr(0, 2) + " " + std::to_string(lines) +
                        " " + order.substr(2) + " " + std::to_string(length) + "\n";
    for (int line = 0; line < lines; ++line) {
      for (int i = 0; i < length; ++i) {
        const int a = coordinate(order[0], order[1], line), b = coordinate(order[2], order[3], i);
        const int pixel = order[1] == 'X' ? b * kWidth + a : a * kWidth + b;
        bytes += std::string(3, char(0x80 + pixel)) + '\x80';
      }
    }
    const Image image = load_image(folder.write("a.hdr", bytes)).image;
    ASSERT_EQ(image.width, kWidth) << order;
    for (int pixel = 0; pixel < kWidth * kHeight; ++pixel) {
      EXPECT_EQ(image.pixels[std::size_t(3 * pixel)], float(0x80 + pixel) / 256) << order << ", " << pixel;
    }
  }
}

// Of the primaries of ITU-R BT.2020: its green in Rec.709 (BT.2087: -.5876, 1.1329, -.1006).
TEST(RadianceHeader, PrimariesAreThoseOfThePixels) {
  const TemporaryFolder folder;
  const std::string header = "PRIMARIES=0.708 0.292 0.170 0.797 0.131 0.046 0.3127 0.3290\n";
  const auto file = folder.write("a.hdr", picture(header));
  ASSERT_TRUE(read_radiance_header(file).chromaticities.has_value());
  ImageFile image = load_image(file);
  image.image.pixels = {0, 1, 0, 0, 0, 0};
  const Vec3f green = scene_linear_rec709(image, file.string()).at(0);
  EXPECT_NEAR(green.x, -0.5876F, 1e-3F);
  EXPECT_NEAR(green.y, 1.1329F, 1e-3F);
  EXPECT_NEAR(green.z, -0.1006F, 1e-3F);
}

// As Photoshop and ImageMagick write it.
TEST(RadianceHeader, PrimariesOfZerosAreNotStated) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.hdr", picture("GAMMA=1\nPRIMARIES=0 0 0 0 0 0 0 0\n"));
  EXPECT_FALSE(read_radiance_header(file).chromaticities.has_value());
  EXPECT_NO_THROW(scene_linear_rec709(load_image(file), file.string()));
}

TEST(RadianceHeader, WhatCannotBeUndoneIsRefused) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(read(folder, picture("GAMMA=1.0\n")));
  for (const char* header : {"GAMMA=2.2\n", "EXPOSURE=0\n", "EXPOSURE=-1\n", "EXPOSURE=nan\n", "EXPOSURE=much\n",
                             "COLORCORR=1 2\n", "PRIMARIES=0.7 0.3\n"}) {
    EXPECT_THROW(read(folder, picture(header)), Error) << header;
  }
}

}  // namespace
}  // namespace chiaro::renderer

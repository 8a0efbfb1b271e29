#include "renderer/image/encoded_image.h"

#include <gtest/gtest.h>

namespace chiaro::renderer {
namespace {

TEST(EncodedImage, APictureOfOneColorMayBeTiny) { EXPECT_TRUE(may_hold(60, 4UL * 8192 * 8192)); }

TEST(EncodedImage, AGigabyteIsNotInAKilobyte) {
  EXPECT_FALSE(may_hold(1000, 1UL << 30));
  EXPECT_TRUE(may_hold(200'000, 1UL << 30));
}

TEST(EncodedImage, WhatItIsGoesByItsBytesAndThenByItsName) {
  const std::string jpeg = "\xff\xd8\xff\xe0 and so on";
  EXPECT_EQ(format_of(jpeg), "jpeg");
  EXPECT_EQ(format_of(jpeg, "picture.png"), "jpeg");
  EXPECT_EQ(format_of(jpeg.substr(0, 2)), "");
  EXPECT_EQ(format_of(std::string("MM\0\x2a and so on", 13)), "tiff");
  EXPECT_EQ(format_of("RIFF....WEBP"), "webp");
  EXPECT_EQ(format_of("RIFF....WAVE"), "");
  EXPECT_EQ(format_of("this is text", "picture.EXR"), "openexr");
  EXPECT_EQ(format_of("", "picture.tga"), "targa");
  EXPECT_EQ(format_of("GIF89a", "picture.gif"), "");
}

// OpenImageIO reads what memory has behind the palette, and nothing of colours that have too few bits.
TEST(EncodedImage, ATgaWithAPaletteOrWithTooFewBitsIsRefused) {
  const auto tga = [](char type, char bits) {
    return std::string("\0\1", 2) + type + std::string(13, '\0') + bits + '\0';
  };
  for (const char type : {1, 9}) EXPECT_EQ(find_damage("targa", tga(type, 8)), "has a palette");
  for (const char type : {2, 10}) {
    EXPECT_EQ(find_damage("targa", tga(type, 8)), "has colours of 8 bits");
    for (const char bits : {15, 16, 24, 32}) EXPECT_FALSE(find_damage("targa", tga(type, bits)));
  }
  for (const char type : {3, 11}) EXPECT_FALSE(find_damage("targa", tga(type, 8)));
  EXPECT_EQ(find_damage("targa", tga(2, 24).substr(0, 17)), "is truncated");
}

TEST(EncodedImage, WhatReadersSayOfAJpegIsMostlyHarmless) {
  EXPECT_FALSE(tells_damage("jpeg", "JPEG error: Invalid SOS parameters for sequential JPEG"));
  EXPECT_TRUE(tells_damage("jpeg", "JPEG error: Corrupt JPEG data: 5 extraneous bytes before marker 0xd9"));
  EXPECT_TRUE(tells_damage("tiff", "anything"));
}

}  // namespace
}  // namespace chiaro::renderer

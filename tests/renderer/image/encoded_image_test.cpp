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
    return std::string("\0\0", 2) + type + std::string(13, '\0') + bits + '\0';
  };
  for (const char type : {1, 9}) EXPECT_EQ(find_damage("targa", tga(type, 8)), "has a palette");
  for (const char type : {2, 10}) {
    EXPECT_EQ(find_damage("targa", tga(type, 8)), "has colours of 8 bits");
    for (const char bits : {15, 16, 24, 32}) EXPECT_FALSE(find_damage("targa", tga(type, bits)));
  }
  for (const char type : {3, 11}) EXPECT_FALSE(find_damage("targa", tga(type, 8)));
  EXPECT_EQ(find_damage("targa", tga(2, 24).substr(0, 17)), "is truncated");
  EXPECT_EQ(find_damage("targa", tga(2, 24).substr(0, 17) + '\x40'), "has interleaved lines");
}

// OpenImageIO makes white of samples up to 0, and overflows above 32767.
TEST(EncodedImage, APnmWhoseSamplesAreNotReadRightIsRefused) {
  for (const char* header : {"P6\n2 2\n255\n", "P5 2 2 65535\n", "P6\n# a comment 0\n2 2\n255\n", "P4\n8 1\n\xff",
                             "PF\n2 2\n-1.0\n", "Pf\n2 2\n0.5\n"}) {
    EXPECT_EQ(find_damage("pnm", header), std::nullopt) << header;
  }
  for (const char* header : {"", "P6", "P6\n2 2\n", "P6\n2 2\n0\n", "P6\n2 2\n-5\n", "P6\n2 2\n40000\n",
                             "P6\n2 2\n65536\n", "P6\n2 2\n9.5\n", "P3\n2 2\n255\n", "PF\n2 2\n0\n", "PF\n2 2\nnan\n",
                             "PF\n2 2\n1e99\n", "PF\n2 2\nx\n", "PF4\n2 2\n-1.0\n", "PF\r\n2 2\r\n-1.0\r\n"}) {
    EXPECT_NE(find_damage("pnm", header), std::nullopt) << header;
  }
}

TEST(EncodedImage, WhatReadersSayOfAJpegIsMostlyHarmless) {
  EXPECT_FALSE(tells_damage("jpeg", "JPEG error: Invalid SOS parameters for sequential JPEG"));
  EXPECT_TRUE(tells_damage("jpeg", "JPEG error: Corrupt JPEG data: 5 extraneous bytes before marker 0xd9"));
  EXPECT_TRUE(tells_damage("tiff", "anything"));
}

}  // namespace
}  // namespace chiaro::renderer

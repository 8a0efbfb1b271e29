#include "renderer/image/encoded_image.h"

#include <gtest/gtest.h>

namespace chiaro::renderer {
namespace {

TEST(EncodedImage, APictureOfOneColorMayBeTiny) { EXPECT_TRUE(may_hold(60, 4UL * 8192 * 8192)); }

TEST(EncodedImage, AGigabyteIsNotInAKilobyte) {
  EXPECT_FALSE(may_hold(1000, 1UL << 30));
  EXPECT_TRUE(may_hold(200'000, 1UL << 30));
}

std::string bmp_of_header(char size) {
  return std::string("BM") + std::string(12, '\0') + size + std::string(200, '\0');
}

// OpenImageIO takes what it does not know for read, and its size for whatever memory had.
TEST(EncodedImage, ABmpHasAHeaderOfAKindThatThereIs) {
  for (const int size : {12, 40, 52, 56, 108, 124}) EXPECT_FALSE(find_damage("bmp", bmp_of_header(char(size)))) << size;
  for (const int size : {0, 11, 16, 41, 64, 128})
    EXPECT_EQ(find_damage("bmp", bmp_of_header(char(size))), "is corrupt") << size;
  EXPECT_EQ(find_damage("bmp", bmp_of_header(40).substr(0, 17)), "is truncated");
  EXPECT_FALSE(find_damage("bmp", bmp_of_header(40).substr(0, 18)));
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

// OpenImageIO reads what memory has behind the palette.
TEST(EncodedImage, ATgaWithAPaletteIsRefused) {
  const auto of_type = [](char type) { return std::string("\0\1", 2) + type + std::string(15, '\0'); };
  for (const char type : {1, 9}) EXPECT_EQ(find_damage("targa", of_type(type)), "has a palette");
  for (const char type : {2, 3, 10, 11}) EXPECT_FALSE(find_damage("targa", of_type(type)));
  EXPECT_EQ(find_damage("targa", "\0"), "is truncated");
}

}  // namespace
}  // namespace chiaro::renderer

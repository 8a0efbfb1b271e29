#include "renderer/image/mip_maps.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "renderer/image/texel_encoding.h"

namespace chiaro::renderer {
namespace {

// Texels of all values, without order.
Texture noise(int width, int height) {
  Texture texture{"", width, height, {}};
  std::uint32_t state = 1;
  for (int i = 0; i < 4 * width * height; ++i)
    texture.rgba.push_back(std::uint8_t((state = 1664525U * state + 1013904223U) >> 24));
  return texture;
}

double mean(const MipLevel& level, int channel, bool srgb) {
  double sum = 0;
  const std::size_t count = std::size_t(level.width) * level.height;
  for (std::size_t i = 0; i < count; ++i) sum += double(decode_table(srgb)[level.texels[4 * i + channel]]);
  return sum / double(count);
}

TEST(MipMaps, EveryLevelHasTheMeanOfTheTexture) {
  // Rounding to 8 bits of N texels moves the mean by at most half a step, and mostly by far less.
  for (const auto& [width, height] : {std::pair{64, 64}, {37, 53}, {100, 3}, {1, 7}}) {
    for (const bool srgb : {false, true}) {
      Texture texture = noise(width, height);
      make_mip_maps(texture, {.srgb = srgb});
      for (int k = 1; k <= int(texture.mips.size()); ++k) {
        for (int c = 0; c < 4; ++c) {
          const bool decoded = srgb && c < 3;
          const double expected = mean(mip_level(texture, 0), c, decoded);
          EXPECT_NEAR(mean(mip_level(texture, k), c, decoded), expected, 0.005) << width << ", level " << k;
        }
      }
    }
  }
}

TEST(MipMaps, GoDownToOneTexelInAThirdMoreMemory) {
  Texture texture = noise(64, 16);
  make_mip_maps(texture, {});
  EXPECT_EQ(texture.mips.size(), 6U);
  EXPECT_EQ(texture.mips.back().size(), 4U);
  std::size_t bytes = 0;
  for (const auto& mip : texture.mips) bytes += mip.size();
  EXPECT_LE(double(bytes), double(texture.rgba.size()) / 3 * 1.01);
}

TEST(MipMaps, ColoursAreAveragedInLinearLight) {
  Texture texture{"", 2, 1, {0, 0, 0, 255, 255, 255, 255, 255}};
  Texture data = texture;
  make_mip_maps(texture, {.srgb = true});
  make_mip_maps(data, {});
  EXPECT_EQ(texture.mips[0][0], 188);  // sRGB of one half
  EXPECT_EQ(data.mips[0][0], 128);
}

TEST(MipMaps, WhatIsNotThereHasNoSayInTheColour) {
  Texture texture{"", 2, 2, {200, 10, 20, 255, 0, 255, 0, 0, 200, 10, 20, 255, 0, 255, 0, 0}};
  make_mip_maps(texture, {.alpha_weighted = true});
  EXPECT_EQ(texture.mips[0], (std::vector<std::uint8_t>{200, 10, 20, 128}));
}

TEST(MipMaps, SixteenBitsStaySixteen) {
  Texture texture{"", 2, 1, {}};
  texture.wide_rgba = {300, 0, 7, 65535, 100, 1, 7, 65534};
  Texture data = texture;
  make_mip_maps(data, {});
  EXPECT_TRUE(data.mips.empty());
  ASSERT_EQ(data.wide_mips.size(), 1U);
  EXPECT_EQ(data.wide_mips[0], (std::vector<std::uint16_t>{200, 1, 7, 65535}));
  make_mip_maps(texture, {.srgb = true});
  EXPECT_EQ(texture.wide_mips[0][0], 200) << "on the straight part of the curve";
}

// A lit window of a dark town: 8 bits per channel would end in darkness.
TEST(MipMaps, FewBrightTexelsAmongDarkOnesStay) {
  constexpr int kSide = 128;
  Texture texture{"", kSide, kSide, std::vector<std::uint8_t>(4 * kSide * kSide, 0)};
  for (int c = 0; c < 4; ++c) texture.rgba[std::size_t(4 * (5 * kSide + 77) + c)] = 255;
  make_mip_maps(texture, {.srgb = true, .wide = true});
  EXPECT_TRUE(texture.rgba.empty());
  ASSERT_EQ(texture.wide_mips.size(), 7U);
  for (int k = 0; k <= 7; ++k) {
    const auto level = mip_level<std::uint16_t>(texture, k);
    double sum = 0;
    for (int i = 0; i < level.width * level.height; ++i) {
      sum += double(decode_table<std::uint16_t>(true)[level.texels[4 * i]]);
    }
    EXPECT_NEAR(sum / (level.width * level.height) * kSide * kSide, 1, 0.01) << "level " << k;
  }
}

TEST(MipMaps, WideTexelsAreTheSame) {
  for (int i = 0; i < 256; ++i) EXPECT_EQ(decode_table<std::uint16_t>(true)[257 * i], decode_table(true)[i]);
}

TEST(MipMaps, EncodingIsTheInverseOfDecoding) {
  for (int i = 0; i < 256; ++i) EXPECT_EQ(encode_srgb(decode_table(true)[i]), i);
  for (int i = 0; i < 65536; ++i) ASSERT_EQ(encode_wide_srgb(decode_table<std::uint16_t>(true)[i]), i);
}

}  // namespace
}  // namespace chiaro::renderer

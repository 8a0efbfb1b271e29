#include "renderer/trace/texture_lookup.h"

#include <gtest/gtest.h>

#include "renderer/image/mip_maps.h"

namespace chiaro::renderer {
namespace {

// Four texels in a row: red 0, 51, 102, 255.
Texture row(Wrap wrap = Wrap::kRepeat) {
  Texture texture{"", 4, 1, {}};
  for (const std::uint8_t v : {0, 51, 102, 255}) texture.rgba.insert(texture.rgba.end(), {v, 0, 0, v});
  texture.wrap_u = texture.wrap_v = wrap;
  return texture;
}

float red(const Texture& texture, float u) { return look_up(texture, {u, 0.5F}, false).x; }

TEST(TextureLookup, TexelCentresAreExactAndBetweenThemIsLinear) {
  const Texture texture = row();
  EXPECT_NEAR(red(texture, 0.125F), 0.0F, 1e-6F);
  EXPECT_NEAR(red(texture, 0.375F), 0.2F, 1e-6F);
  EXPECT_NEAR(red(texture, 0.625F), 0.4F, 1e-6F);
  EXPECT_NEAR(red(texture, 0.875F), 1.0F, 1e-6F);
  EXPECT_NEAR(red(texture, 0.5F), 0.3F, 1e-6F);
  EXPECT_NEAR(red(texture, 0.4375F), 0.25F, 1e-6F);
}

TEST(TextureLookup, IsBilinear) {
  Texture texture{"", 2, 2, {}};
  for (const std::uint8_t v : {0, 51, 102, 255}) texture.rgba.insert(texture.rgba.end(), {v, v, v, 255});
  texture.wrap_u = texture.wrap_v = Wrap::kClampToEdge;
  EXPECT_NEAR(look_up(texture, {0.5F, 0.5F}, false).y, (0 + 0.2F + 0.4F + 1) / 4, 1e-6F);
  // A quarter of the way to the right, three quarters down.
  const float expected = 0.25F * (0.75F * 0 + 0.25F * 0.2F) + 0.75F * (0.75F * 0.4F + 0.25F * 1);
  EXPECT_NEAR(look_up(texture, {0.375F, 0.625F}, false).z, expected, 1e-6F);
  // Rows start at the top.
  EXPECT_NEAR(look_up(texture, {0.25F, 0.75F}, false).x, 0.4F, 1e-6F);
}

TEST(TextureLookup, BlendsColoursInLinearLightUnlessFilteredAsStored) {
  Texture texture{"", 2, 1, {}};
  for (const std::uint8_t v : {0, 200}) texture.rgba.insert(texture.rgba.end(), {v, v, v, v});
  const auto decoded = [](double v) { return float(std::pow((v / 255 + 0.055) / 1.055, 2.4)); };
  EXPECT_NEAR(look_up(texture, {0.5F, 0.5F}, true).x, decoded(200) / 2, 1e-6F);
  texture.filtered_as_stored = true;
  EXPECT_NEAR(look_up(texture, {0.5F, 0.5F}, true).x, decoded(100), 1e-6F);
  EXPECT_NEAR(look_up(texture, {0.5F - 0.125F / 2, 0.5F}, true).x, decoded(75), 1e-6F);
  EXPECT_NEAR(look_up(texture, {0.5F - 0.125F / 2.02F, 0.5F}, true).x, decoded(200 * (0.5 - 0.25 / 2.02)), 1e-5F);
  EXPECT_NEAR(look_up(texture, {0.75F, 0.5F}, true).x, decoded(200), 1e-6F);
  EXPECT_NEAR(look_up(texture, {0.5F, 0.5F}, true).w, 100 / 255.0F, 1e-6F);
  EXPECT_NEAR(look_up(texture, {0.5F, 0.5F}, false).x, 100 / 255.0F, 1e-6F);
}

// What lies between two steps of 8 bits: darker than their darkest, and the tilt of a normal map.
TEST(TextureLookup, SixteenBitsAreNotCutToEight) {
  Texture texture{"", 2, 1, {}};
  texture.wide_rgba = {100, 32896, 700, 65535, 300, 32896, 700, 300};
  texture.wrap_u = Wrap::kClampToEdge;
  const Vec4f data = look_up(texture, {0.5F, 0.5F}, false), color = look_up(texture, {0.5F, 0.5F}, true);
  EXPECT_NEAR(data.x, 200 / 65535.0F, 1e-8F);
  EXPECT_NEAR(data.y, 32896 / 65535.0F, 1e-7F);
  EXPECT_NEAR(color.x, 200 / 65535.0F / 12.92F, 1e-8F);
  EXPECT_NEAR(color.w, (65535 + 300) / 2 / 65535.0F, 1e-5F);
  texture.filtered_as_stored = true;
  EXPECT_NEAR(look_up(texture, {0.5F, 0.5F}, true).z, 700 / 65535.0F / 12.92F, 1e-8F);
  for (const bool nearest : {false, true}) {
    texture.nearest = nearest;
    EXPECT_NEAR(look_up_alpha(texture, {1, 0.5F}), 300 / 65535.0F, 1e-8F);
    EXPECT_NEAR(look_up(texture, {1, 0.5F}, false).x, 300 / 65535.0F, 1e-8F);
  }
}

TEST(TextureLookup, WrapsAsAsked) {
  // The texel that the coordinate u - 1/4 of the first one lies on: the last, the first mirrored, the first.
  EXPECT_NEAR(red(row(Wrap::kRepeat), -0.125F), 1, 1e-6F);
  EXPECT_NEAR(red(row(Wrap::kMirroredRepeat), -0.125F), 0, 1e-6F);
  EXPECT_NEAR(red(row(Wrap::kClampToEdge), -0.125F), 0, 1e-6F);
  EXPECT_NEAR(red(row(Wrap::kRepeat), 1.375F), 0.2F, 1e-6F);
  EXPECT_NEAR(red(row(Wrap::kMirroredRepeat), 1.375F), 0.4F, 1e-6F);
  EXPECT_NEAR(red(row(Wrap::kClampToEdge), 1.375F), 1, 1e-6F);
  EXPECT_NEAR(red(row(Wrap::kMirroredRepeat), 2.375F), 0.2F, 1e-6F);
  // Across the seam.
  EXPECT_NEAR(red(row(Wrap::kRepeat), 0), 0.5F, 1e-6F);
  EXPECT_NEAR(red(row(Wrap::kMirroredRepeat), 1), 1, 1e-6F);
  EXPECT_NEAR(red(row(Wrap::kClampToEdge), 0), 0, 1e-6F);
}

TEST(TextureLookup, NearestTakesTheTexelUnderTheCoordinate) {
  Texture texture = row();
  texture.nearest = true;
  EXPECT_NEAR(red(texture, 0.26F), 0.2F, 1e-6F);
  EXPECT_NEAR(red(texture, 0.49F), 0.2F, 1e-6F);
  EXPECT_NEAR(red(texture, 0.51F), 0.4F, 1e-6F);
}

TEST(TextureLookup, ColourIsDecodedBeforeFilteringAndAlphaNever) {
  Texture texture{"", 2, 1, {0, 188, 10, 0, 255, 188, 10, 102}};
  texture.wrap_u = Wrap::kClampToEdge;
  const Vec4f middle = look_up(texture, {0.5F, 0.5F}, true);
  EXPECT_NEAR(middle.x, 0.5F, 1e-6F);
  EXPECT_NEAR(middle.y, 0.502887F, 1e-5F);             // the power law
  EXPECT_NEAR(middle.z, 10 / 255.0F / 12.92F, 1e-6F);  // the straight part
  EXPECT_NEAR(middle.w, 0.2F, 1e-6F);
}

TEST(TextureLookup, LevelsHaveFourToEightTexelsAcrossTheFootprint) {
  for (const auto& [across, level] : {std::pair{0.0F, 0}, {7.9F, 0}, {8.1F, 1}, {15.9F, 1}, {16.1F, 2}, {65.0F, 4}}) {
    EXPECT_EQ(mip_level_of(across * across), level) << across;
  }
  EXPECT_EQ(mip_level_of(std::nanf("")), 0);
  EXPECT_GE(mip_level_of(kInfinity), 30);
}

TEST(TextureLookup, LevelsAreLookedUpAtTheSamePlace) {
  // A ramp across an 8 × 8 texture stays that ramp on coarser levels, away from the sides.
  Texture texture{"", 8, 8, {}};
  for (int i = 0; i < 64; ++i) texture.rgba.insert(texture.rgba.end(), {std::uint8_t(32 * (i % 8)), 0, 0, 255});
  texture.wrap_u = Wrap::kClampToEdge;
  make_mip_maps(texture, {});
  for (const float u : {0.3F, 0.5F, 0.6F}) {
    const float full = look_up(texture, {u, 0.5F}, false).x;
    EXPECT_NEAR(look_up(texture, {u, 0.5F}, false, 1).x, full, 0.003F) << u;
    EXPECT_NEAR(look_up(texture, {u, 0.5F}, false, 2).x, full, 0.003F) << u;
  }
  EXPECT_NEAR(look_up(texture, {0.9F, 0.5F}, false, 99).x, 3.5F * 32 / 255, 0.003F);
}

TEST(TextureLookup, AlphaAloneIsThatOfTheColour) {
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirroredRepeat, Wrap::kClampToEdge}) {
    Texture texture = row(wrap);
    for (const bool nearest : {false, true}) {
      texture.nearest = nearest;
      for (float u = -1.3F; u < 2.5F; u += 0.17F) {
        EXPECT_NEAR(look_up_alpha(texture, {u, 0.3F}), look_up(texture, {u, 0.3F}, true).w, 1e-6F) << u;
      }
    }
  }
}

TEST(TextureLookup, LargeAndBrokenCoordinatesAreHarmless) {
  const float big[] = {1e5F + 0.375F, -1e5F + 0.375F};
  for (const float u : big) EXPECT_NEAR(red(row(), u), 0.2F, 0.05F);
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirroredRepeat, Wrap::kClampToEdge}) {
    for (const float u : {1e30F, -1e30F, kInfinity, -kInfinity, std::nanf("")}) {
      const float value = red(row(wrap), u);
      EXPECT_TRUE(value >= 0 && value <= 1) << u;
    }
  }
}

}  // namespace
}  // namespace chiaro::renderer

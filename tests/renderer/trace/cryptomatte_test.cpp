#include "renderer/trace/cryptomatte.h"

#include <bit>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/code_scenes.h"

namespace chiaro::renderer {
namespace {

TEST(Cryptomatte, HashesAreThoseOfAppleby) {
  // Known answers of MurmurHash3_x86_32 with seed 0, of all lengths modulo four.
  EXPECT_EQ(murmur_hash_3_32(""), 0U);
  EXPECT_EQ(murmur_hash_3_32("a"), 0x3c2569b2U);
  EXPECT_EQ(murmur_hash_3_32("hello"), 0x248bfa47U);
  EXPECT_EQ(murmur_hash_3_32("hello, world"), 0x149bbb7fU);
  EXPECT_EQ(murmur_hash_3_32("The quick brown fox jumps over the lazy dog"), 0x2e4ff723U);
}

TEST(Cryptomatte, IdentifiersAreOrdinaryFloats) {
  int turned = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::string name = "object" + std::to_string(i);
    const std::uint32_t id = matte_id(name);
    EXPECT_TRUE(std::isnormal(std::bit_cast<float>(id))) << name;
    if (id == murmur_hash_3_32(name)) continue;
    ++turned;
    EXPECT_EQ(id ^ murmur_hash_3_32(name), 1U << 23);
  }
  EXPECT_GT(turned, 20000 / 128 / 2);  // two exponents of 256
}

TEST(Cryptomatte, LargestCoveragesComeFirst) {
  MatteSums sums;
  add_matte(sums, 11, 0, 1);
  add_matte(sums, 22, 0, 2);
  add_matte(sums, 22, 1, 6);
  add_matte(sums, 33, 1, 2);
  float channels[2 * kMatteLevels];
  write_mattes(sums, {0.5 / 4, 0.5 / 8}, channels);
  const float coverages[] = {0.625F, 0.125F, 0.125F, 0, 0, 0};
  const std::uint32_t ids[] = {22, 11, 33, 0, 0, 0};
  for (int i = 0; i < kMatteLevels; ++i) {
    EXPECT_EQ(std::bit_cast<std::uint32_t>(channels[2 * i]), ids[i]) << i;
    EXPECT_FLOAT_EQ(channels[2 * i + 1], coverages[i]) << i;
  }
}

TEST(Cryptomatte, ManifestsNameWhatIsDrawn) {
  Scene scene = test::corner_with_ball();
  scene.materials[1].name = "plaster";
  const std::vector<Matte> mattes = mattes_of(scene);
  ASSERT_EQ(mattes.size(), 2U);
  EXPECT_EQ(mattes[0].layer, "CryptoObject");
  ASSERT_EQ(mattes[0].manifest.size(), 4U);
  EXPECT_EQ(mattes[0].manifest[0].first, "back");
  EXPECT_EQ(mattes[0].manifest[0].second, matte_id("back"));
  EXPECT_EQ(mattes[1].manifest.back().first, "plaster");
  EXPECT_EQ(matte_ids(scene).materials[0], matte_id("material_0"));
}

TEST(Cryptomatte, ChannelsAreOfTheSpecification) {
  const auto names = matte_channels("CryptoObject");
  ASSERT_EQ(names.size(), 12U);
  EXPECT_EQ(names.front(), "CryptoObject00.R");
  EXPECT_EQ(names.back(), "CryptoObject02.A");
}

}  // namespace
}  // namespace chiaro::renderer

#include "renderer/image/exr_header.h"

#include <gtest/gtest.h>

#include <cstring>

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/image/exr_tiles.h"
#include "renderer/image/image_file.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::renderer {
namespace {

std::string number(std::uint32_t value) {
  std::string bytes(4, '\0');
  std::memcpy(bytes.data(), &value, 4);
  return bytes;
}

std::string attribute(const std::string& name, std::uint32_t claimed_size, const std::string& contents) {
  return name + '\0' + "string" + '\0' + number(claimed_size) + contents;
}

std::string header(std::uint32_t version, const std::string& attributes) {
  return number(20000630) + number(version) + attributes;
}

std::optional<std::string> damage_of(const std::string& bytes) {
  const test::TemporaryFolder folder;
  return find_exr_header_damage(folder.write("a.exr", bytes));
}

TEST(ExrHeader, FilesOfOursAreWhole) {
  const test::TemporaryFolder folder;
  Image image = make_image(3, 2, {"R", "G", "B"});
  save_image(image, folder / "a.exr", PixelType::kHalf, {{"note", std::string(5000, 'x')}});
  EXPECT_EQ(find_exr_header_damage(folder / "a.exr"), std::nullopt);
}

TEST(ExrHeader, OtherFilesAreNotItsConcern) {
  EXPECT_EQ(damage_of(""), std::nullopt);
  EXPECT_EQ(damage_of("v/"), std::nullopt);
  EXPECT_EQ(damage_of("\x89PNG and so on"), std::nullopt);
}

TEST(ExrHeader, PartsOfMultipartFilesArePassed) {
  const std::string part = attribute("name", 2, "ab") + '\0';
  EXPECT_EQ(damage_of(header(2 | 0x1000, part + part + '\0')), std::nullopt);
}

TEST(ExrHeader, AnAttributeLongerThanTheFileIsNamedBeforeMemoryIsTakenForIt) {
  for (const std::uint32_t size : {3U, 0x7FFFFFFFU, 0xFFFFFFFFU}) {
    const std::string bytes = header(2, attribute("note", size, "ab"));
    EXPECT_NE(damage_of(bytes).value_or("").find("\"note\""), std::string::npos) << size;
    const test::TemporaryFolder folder;
    EXPECT_THROW(load_image(folder.write("a.exr", bytes)), Error);
    EXPECT_THROW(ExrTileReader(folder / "a.exr"), Error);
  }
}

TEST(ExrHeader, TilesAndLinesBeyondAllMeasureAreRefused) {
  const auto window = [](std::uint32_t last) {
    return std::string("dataWindow") + '\0' + "box2i" + '\0' + number(16) + number(0) + number(0) + number(last) +
           number(0);
  };
  const auto tiles = [](std::uint32_t width, std::uint32_t height) {
    return std::string("tiles") + '\0' + "tiledesc" + '\0' + number(9) + number(width) + number(height) + '\0';
  };
  const auto typed = [](const std::string& type) {
    return std::string("type") + '\0' + "string" + '\0' + number(std::uint32_t(type.size())) + type;
  };
  const auto compressed = [](char how) {
    return std::string("compression") + '\0' + "compression" + '\0' + number(1) + how;
  };
  constexpr std::uint32_t kLines = 2, kTiled = 2 | 0x200, kMultipart = 2 | 0x1000;
  const auto damage = [](std::uint32_t version, const std::string& attributes) {
    return damage_of(header(version, attributes + '\0' + '\0') + std::string(4096, 'x')).value_or("nothing");
  };
  for (const std::string& wide : {window(1U << 30), window(1U << 30) + tiles(1, 1024),
                                  window((1U << 20) - 1) + compressed(9), window((1U << 20) - 1) + compressed(77)}) {
    EXPECT_NE(damage(kLines, wide).find("lines of"), std::string::npos);
    EXPECT_NE(damage(kTiled, typed("scanlineimage") + wide).find("lines of"), std::string::npos);
    EXPECT_NE(damage(kMultipart, wide).find("lines of"), std::string::npos);
  }
  for (const std::string& large : {tiles(1U << 20, 1U << 20), tiles(0xFFFFFFFF, 0xFFFFFFFF)}) {
    EXPECT_NE(damage(kTiled, large).find("tiles of"), std::string::npos);
    EXPECT_NE(damage(kLines, typed("tiledimage") + large).find("tiles of"), std::string::npos);
    EXPECT_NE(damage(kMultipart, typed("tiledimage") + large).find("tiles of"), std::string::npos);
  }
  for (const std::uint32_t width : {1U << 8, 1U << 22}) {
    const std::string expected =
        width == 1U << 22 ? "nothing" : "is cut short, or its header is corrupt: 4194305 x 1 tiles in ";
    const std::string tiled = window(1U << 30) + tiles(width, 4);
    EXPECT_EQ(damage(kTiled, tiled).substr(0, expected.size()), expected);
    EXPECT_EQ(damage(kMultipart, typed("tiledimage") + tiled + '\0').substr(0, expected.size()), expected);
  }
  EXPECT_EQ(damage(kLines, window(4095) + compressed(9)), "nothing");
  EXPECT_EQ(damage(kLines, window((1U << 20) - 1) + compressed(3)), "nothing");
}

// Readers take them at their own length, and would find another header than the one that was looked at.
TEST(ExrHeader, ValuesOfAnotherSizeThanTheirTypeAreRefused) {
  const auto damage = [](const std::string& type, const std::string& contents) {
    return damage_of(
        header(2, std::string("x") + '\0' + type + '\0' + number(std::uint32_t(contents.size())) + contents + '\0'));
  };
  EXPECT_EQ(damage("float", std::string(4, 'f')), std::nullopt);
  EXPECT_TRUE(damage("float", std::string(5, 'f')).has_value());
  const auto channel_of = [](std::uint32_t type) {
    return std::string("R") + '\0' + number(type) + std::string(12, '\1');
  };
  const std::string channel = channel_of(1);
  EXPECT_EQ(damage("chlist", channel + channel_of(2) + '\0'), std::nullopt);
  EXPECT_TRUE(damage("chlist", channel + channel_of(3) + '\0').has_value());  // which OpenImageIO ends the program for
  EXPECT_TRUE(damage("chlist", channel + '\0' + channel + '\0').has_value());
  EXPECT_TRUE(damage("chlist", channel).has_value());
}

TEST(ExrHeader, AttributesThatDecideOfSizesMayNotComeTwice) {
  const auto twice = [](const std::string& name, const std::string& type, std::uint32_t size) {
    const std::string one = name + '\0' + type + '\0' + number(size) + std::string(size, '\1');
    return damage_of(header(2, one + one) + '\0');
  };
  EXPECT_EQ(twice("compression", "compression", 1), "its header is corrupt: attribute \"compression\" twice");
  EXPECT_EQ(twice("owner", "string", 3), std::nullopt);
}

TEST(ExrHeader, PrimariesOfAnotherTypeAreRefused) {
  const auto damage = [](const std::string& type, std::uint32_t size) {
    return damage_of(
        header(2, std::string("chromaticities") + '\0' + type + '\0' + number(size) + std::string(size, 'f') + '\0'));
  };
  EXPECT_EQ(damage("chromaticities", 32), std::nullopt);
  EXPECT_EQ(damage("v2f", 8), "its header is corrupt: chromaticities of type \"v2f\"");
}

TEST(ExrHeader, AHeaderThatEndsEarlyIsCutShort) {
  const std::string whole = header(2, attribute("note", 2, "ab")) + '\0';
  for (std::size_t length = 8; length < whole.size(); ++length) {
    EXPECT_TRUE(damage_of(whole.substr(0, length)).has_value()) << length;
  }
  EXPECT_EQ(damage_of(whole), std::nullopt);
}

}  // namespace
}  // namespace chiaro::renderer

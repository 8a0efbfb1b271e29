#include "renderer/image/exr_chunks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "renderer/core/atomic_file.h"
#include "renderer/core/sampler.h"
#include "renderer/image/exr_header.h"
#include "renderer/image/exr_tiles.h"
#include "renderer/image/image_file.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::renderer {
namespace {

std::string numbers(const std::vector<std::uint32_t>& values) {
  std::string bytes(4 * values.size(), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

ExrTiles square_tiles(int width, int height, int tile, std::vector<std::string> channels) {
  return {.width = width,
          .height = height,
          .first_column = 0,
          .last_column = width,
          .tile_width = tile,
          .tile_height = tile,
          .channels = std::move(channels)};
}

const std::string kNothingDeflated("\x78\x9c\x03\0\0\0\0\1", 8);

// With this in the place of the last chunk, which begins with these numbers and its size.
std::string with_last_chunk(const std::string& bytes, const std::vector<std::uint32_t>& place,
                            const std::string& contents) {
  const std::string begin = numbers(place);
  for (std::size_t at = bytes.rfind(begin); at != std::string::npos && at > 0; at = bytes.rfind(begin, at - 1)) {
    const std::size_t data = at + begin.size() + 4;
    if (data > bytes.size() || bytes.substr(data - 4, 4) != numbers({std::uint32_t(bytes.size() - data)})) continue;
    return bytes.substr(0, data - 4) + numbers({std::uint32_t(contents.size())}) + contents;
  }
  ADD_FAILURE() << "no such chunk";
  return bytes;
}

TEST(ExrChunks, LinesThatDoNotHoldAllTheirPixelsAreRefused) {
  const test::TemporaryFolder folder;
  Image image = make_image(8, 32, {"R", "G", "B"});
  Sampler sampler(1, 0, 0);
  for (float& value : image.pixels) value = sampler.next_1d();
  const auto path = folder / "t.exr";
  save_image(image, path, PixelType::kHalf);
  EXPECT_EQ(ExrChunks(path).find_damage(0), std::nullopt);
  const std::string whole = read_file(path);
  for (const std::string& contents : {std::string(), kNothingDeflated}) {
    folder.write("t.exr", with_last_chunk(whole, {16}, contents));
    EXPECT_EQ(ExrChunks(path).find_damage(0), "lines do not hold all their pixels");
    EXPECT_NE(test::error_of([&] { load_image(path); }).find("t.exr: pixels: lines do not hold"), std::string::npos);
  }
}

TEST(ExrChunks, TilesThatDoNotHoldAllTheirPixelsAreRefused) {
  const test::TemporaryFolder folder;
  const auto path = folder / "t.exr";
  const ExrTiles shape = square_tiles(8, 8, 4, {"a", "b"});
  ExrTileWriter writer(path, shape, {});
  for (const int row : {0, 1}) writer.write(row, 0, 8, std::vector<float>(64, 0.5F));
  writer.close();
  std::vector<float> pixels(128);
  EXPECT_EQ(ExrChunks(path).find_damage(0), std::nullopt);
  EXPECT_EQ(ExrChunks(path).read_tile(1, 1).size(), 64U);
  EXPECT_TRUE(ExrTileReader(path).read(0, 8, 0, 8, pixels));
  folder.write("t.exr", with_last_chunk(read_file(path), {1, 1, 0, 0}, kNothingDeflated));
  EXPECT_EQ(ExrChunks(path).find_damage(0), "a tile does not hold all its pixels");
  EXPECT_TRUE(ExrChunks(path).read_tile(1, 1).empty());
  EXPECT_FALSE(ExrTileReader(path).read(0, 8, 0, 8, pixels));
  EXPECT_TRUE(ExrTileReader(path).read(0, 4, 0, 8, std::span(pixels).subspan(0, 64)));
  EXPECT_NE(test::error_of([&] { load_image(path); }).find("t.exr: pixels: a tile does not hold"), std::string::npos);
}

// Four tiles of noise, which cannot be compressed, and four of nothing, which can.
std::string write_unfinished(const std::filesystem::path& path) {
  const ExrTiles shape = square_tiles(32, 16, 8, {"a"});
  ExrTileWriter writer(path, shape, {});
  Sampler sampler(1, 0, 0);
  std::vector<float> noise(256);
  for (float& value : noise) {  // any normal half
    const float size = 1 + std::floor(1024 * sampler.next_1d()) / 1024;
    value = std::ldexp(sampler.next_1d() < 0.5F ? -size : size, int(30 * sampler.next_1d()) - 14);
  }
  writer.write(0, 0, 32, noise);
  writer.write(1, 0, 32, std::vector<float>(256, 0.5F));
  writer.close();
  std::string bytes = read_file(path);
  std::fill_n(bytes.begin() + std::ptrdiff_t(*end_of_exr_header(path)), 8 * 8, '\0');
  return bytes;
}

TEST(ExrChunks, TilesAreFoundInFilesThatDoNotSayWhereTheyAre) {
  const test::TemporaryFolder folder;
  const std::string bytes = write_unfinished(folder / "t.exr");
  const std::size_t first = *end_of_exr_header(folder / "t.exr") + 8 * 8, tile = 20 + 128;
  EXPECT_EQ(ExrChunks(folder / "t.exr").count(), 8);
  for (std::size_t size = 0; size <= bytes.size(); size += 3) {
    const ExrChunks chunks(folder.write("t.exr", bytes.substr(0, size)));
    const std::vector<ExrTilePlace> places = chunks.find_tiles();
    if (size >= first) {
      EXPECT_TRUE(chunks.has_table());
    }
    // Of noise, which is stored as it is, not the last.
    const std::size_t whole = size < first ? 0 : (size - first) / tile;
    if (whole < 4) {
      ASSERT_EQ(places.size(), whole == 0 ? 0 : whole - 1) << size;
    }
    for (const ExrTilePlace& place : places) EXPECT_EQ(chunks.read_tile(place).size(), 128U);
  }
  EXPECT_EQ(ExrChunks(folder.write("t.exr", bytes)).find_tiles().size(), 8U);
}

TEST(ExrChunks, ZerosAndTilesThatComeAgainAreNoTiles) {
  const test::TemporaryFolder folder;
  const std::string bytes = write_unfinished(folder / "t.exr");
  const std::size_t first = *end_of_exr_header(folder / "t.exr") + 8 * 8, tile = 20 + 128;
  for (const auto& [begin, count] : {std::pair(60UL, 0UL), {2 * tile + 60, 2UL}, {3 * tile, 2UL}}) {
    std::string zeros = bytes;
    std::fill(zeros.begin() + std::ptrdiff_t(first + begin), zeros.end(), '\0');
    EXPECT_EQ(ExrChunks(folder.write("t.exr", zeros)).find_tiles().size(), count) << begin;
  }
  const std::string again = bytes.substr(0, first + 2 * tile) + bytes.substr(first);
  EXPECT_EQ(ExrChunks(folder.write("t.exr", again)).find_tiles().size(), 1U);
}

// 2²⁵ of them in 500 bytes.
TEST(ExrChunks, MoreTilesThanAFileHasRoomForAreMissing) {
  const test::TemporaryFolder folder;
  const ExrTiles shape = square_tiles(4, 4, 4, {"a"});
  ExrTileWriter writer(folder / "t.exr", shape, {});
  writer.write(0, 0, 4, std::vector<float>(16, 0.5F));
  writer.close();
  std::string bytes = read_file(folder / "t.exr");
  const std::string window = std::string("dataWindow\0box2i\0", 17) + numbers({16});
  const std::size_t corner = bytes.find(window) + window.size() + 8;
  ASSERT_LT(corner, bytes.size());
  bytes.replace(corner, 8, numbers({(1U << 27) - 1, 3}));
  EXPECT_EQ(ExrChunks(folder.write("t.exr", bytes)).find_damage(0), "a tile does not hold all its pixels");
}

TEST(ExrChunks, WhatIsNotThereIsNotItsConcern) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(ExrChunks(folder / "not there.exr").find_damage(0), std::nullopt);
  EXPECT_TRUE(ExrChunks(folder / "not there.exr").read_tile(0, 0).empty());
}

}  // namespace
}  // namespace chiaro::renderer

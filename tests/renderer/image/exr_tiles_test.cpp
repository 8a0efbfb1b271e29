#include "renderer/image/exr_tiles.h"

#include <sys/stat.h>

#include <gtest/gtest.h>

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::renderer {
namespace {

const ExrTiles kShape{.width = 10,
                      .height = 7,
                      .first_column = 2,
                      .last_column = 9,
                      .tile_width = 2,
                      .tile_height = 3,
                      .channels = {"a", "b"}};
const Attributes kAttributes{
    {"x:count", 3}, {"x:scale", 0.5F}, {"x:name", std::string("some")}, {"x:at", std::array<float, 3>{1, 2, 3}}};

float value(int x, int y, int channel) { return float(100 * y + x) + 0.5F * float(channel); }

std::vector<float> part(int top, int bottom, int first, int last) {
  std::vector<float> all;
  for (int y = top; y < bottom; ++y) {
    for (int x = first; x < last; ++x) {
      for (int c = 0; c < 2; ++c) all.push_back(value(x, y, c));
    }
  }
  return all;
}

std::vector<float> pixels(int tile_row, int rows, int first, int last) {
  return part(3 * tile_row, 3 * tile_row + rows, first, last);
}

void write_whole(const std::filesystem::path& path) {
  ExrTileWriter writer(path, kShape, kAttributes);
  for (int row = 0; row < 3; ++row) {
    for (const auto& [first, last] : {std::pair{2, 6}, {6, 9}}) {
      writer.write(row, first, last, pixels(row, kShape.rows_of(row), first, last));
    }
  }
  writer.close();
}

TEST(ExrTiles, ComeBackAsTheyWereWritten) {
  const test::TemporaryFolder folder;
  write_whole(folder / "t.exr");
  EXPECT_TRUE(ExrTileReader::is_tiled(folder / "t.exr"));
  ExrTileReader reader(folder / "t.exr");
  EXPECT_EQ(reader.shape().width, 10);
  EXPECT_EQ(reader.shape().height, 7);
  EXPECT_EQ(reader.shape().first_column, 2);
  EXPECT_EQ(reader.shape().last_column, 9);
  EXPECT_EQ(reader.shape().channels, kShape.channels);
  for (const auto& attribute : kAttributes) {
    const Attributes& found = reader.attributes();
    EXPECT_NE(std::find(found.begin(), found.end(), attribute), found.end()) << attribute.first;
  }
  std::vector<float> read(2 * 7 * 7);
  ASSERT_TRUE(reader.read(0, 7, 2, 9, read));
  EXPECT_EQ(read, pixels(0, 7, 2, 9));
  read.resize(2 * 4 * 3);
  ASSERT_TRUE(reader.read(3, 6, 4, 8, read));
  EXPECT_EQ(read, pixels(1, 3, 4, 8));
}

void write_in_tiles(const std::filesystem::path& path, int tile_width, int tile_height) {
  ExrTiles shape = kShape;
  shape.tile_width = tile_width, shape.tile_height = tile_height;
  ExrTileWriter writer(path, shape, kAttributes);
  for (int row = 0; row * tile_height < shape.height; ++row) {
    const int top = row * tile_height;
    writer.write(row, 2, 9, part(top, top + shape.rows_of(row), 2, 9));
  }
  writer.close();
}

TEST(ExrTiles, AnyPartIsReadWhateverTheTiles) {
  const test::TemporaryFolder folder;
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 3}, {3, 2}, {5, 7}, {4096, 1}, {1, 4096}, {512, 512}}) {
    write_in_tiles(folder / "t.exr", width, height);
    ExrTileReader reader(folder / "t.exr");
    for (int top = 0; top < 7; ++top) {
      for (int bottom = top + 1; bottom <= 7; ++bottom) {
        for (int first = 2; first < 9; ++first) {
          for (int last = first + 1; last <= 9; ++last) {
            const std::vector<float> expected = part(top, bottom, first, last);
            std::vector<float> read(expected.size());
            ASSERT_TRUE(reader.read(top, bottom, first, last, read)) << width << " x " << height;
            ASSERT_EQ(read, expected) << width << " x " << height << ", " << first << " to " << last;
          }
        }
      }
    }
  }
}

TEST(ExrTiles, WhatLiesOutsideIsNotRead) {
  const test::TemporaryFolder folder;
  write_whole(folder / "t.exr");
  ExrTileReader reader(folder / "t.exr");
  std::vector<float> none;
  for (const auto& [first, last] : {std::pair{0, 3}, {1, 2}, {8, 10}, {9, 10}, {5, 5}, {6, 5}, {-5, 1 << 30}}) {
    EXPECT_FALSE(reader.read(0, 3, first, last, none)) << first << " to " << last;
  }
  for (const auto& [top, bottom] : {std::pair{-1, 2}, {6, 8}, {7, 8}, {3, 3}, {4, 3}, {0, 1 << 30}}) {
    EXPECT_FALSE(reader.read(top, bottom, 2, 9, none)) << top << " to " << bottom;
  }
}

// Several times over.
TEST(ExrTiles, MoreThanIsDecodedAtOnceIsRead) {
  const test::TemporaryFolder folder;
  constexpr int kWidth = 2500, kHeight = 1800;
  const ExrTiles shape{.width = kWidth,
                       .height = kHeight,
                       .first_column = 0,
                       .last_column = kWidth,
                       .tile_width = 900,
                       .tile_height = 700,
                       .channels = {"a"}};
  const auto at = [](int x, int y) { return float((31 * x + 17 * y) % 2048); };
  ExrTileWriter writer(folder / "t.exr", shape, {});
  for (int row = 0; row < 3; ++row) {
    std::vector<float> pixels;
    for (int y = 700 * row; y < 700 * row + shape.rows_of(row); ++y) {
      for (int x = 0; x < kWidth; ++x) pixels.push_back(at(x, y));
    }
    writer.write(row, 0, kWidth, pixels);
  }
  writer.close();
  ExrTileReader reader(folder / "t.exr");
  std::vector<float> read(std::size_t(kWidth - 2) * (kHeight - 2));
  ASSERT_TRUE(reader.read(1, kHeight - 1, 1, kWidth - 1, read));
  std::size_t wrong = 0;
  for (int y = 1; y < kHeight - 1; ++y) {
    for (int x = 1; x < kWidth - 1; ++x) {
      wrong += read[std::size_t(y - 1) * (kWidth - 2) + std::size_t(x - 1)] != at(x, y) ? 1 : 0;
    }
  }
  EXPECT_EQ(wrong, 0U);
}

TEST(ExrTiles, WhatHalvesCannotHoldIsClamped) {
  const test::TemporaryFolder folder;
  ExrTileWriter writer(folder / "t.exr", {.width = 2, .height = 1, .last_column = 2, .channels = {"a"}}, {});
  writer.write(0, 0, 2, std::vector<float>{1e9F, -1e9F});
  writer.close();
  ExrTileReader reader(folder / "t.exr");
  std::vector<float> read(2);
  ASSERT_TRUE(reader.read(0, 1, 0, 2, read));
  EXPECT_EQ(read, (std::vector<float>{65504, -65504}));
}

TEST(ExrTiles, FilesThatWereNotFinishedAreReadAsFarAsTheyGo) {
  const test::TemporaryFolder folder;
  {
    ExrTileWriter writer(folder / "t.exr", kShape, kAttributes);
    writer.write(0, 2, 9, pixels(0, 3, 2, 9));
    writer.write(1, 2, 6, pixels(1, 3, 2, 6));
  }  // what a kill leaves has no table of where its tiles are either: zeros
  std::string bytes = read_file(folder / "t.exr");
  ExrTileReader reader(folder / "t.exr");
  std::vector<float> read(2 * 3 * 7);
  ASSERT_TRUE(reader.read(0, 3, 2, 9, read));
  EXPECT_EQ(read, pixels(0, 3, 2, 9));
  EXPECT_FALSE(reader.read(3, 6, 2, 9, read));
  read.resize(2 * 3 * 4);
  EXPECT_TRUE(reader.read(3, 6, 2, 6, read));
}

TEST(ExrTiles, AFullDiskIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP();
  EXPECT_THROW(
      {
        ExrTileWriter writer("/dev/full", kShape, kAttributes);
        for (int row = 0; row < 3; ++row) writer.write(row, 2, 9, pixels(row, kShape.rows_of(row), 2, 9));
        writer.close();
      },
      Error);
}

// Nobody writes into it, and a library would wait for that.
TEST(ExrTiles, PipesAreRefused) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe.exr").c_str(), 0600), 0);
  EXPECT_FALSE(ExrTileReader::is_tiled(folder / "pipe.exr"));
  EXPECT_THROW(ExrTileReader(folder / "pipe.exr"), Error);
}

TEST(ExrTiles, OtherFilesAreRefused) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(ExrTileReader::is_tiled(folder.write("text.exr", "not an image")));
  EXPECT_FALSE(ExrTileReader::is_tiled(folder / "missing.exr"));
  EXPECT_THROW(ExrTileReader(folder / "text.exr"), Error);
  EXPECT_THROW(ExrTileReader(folder / "missing.exr"), Error);
}

}  // namespace
}  // namespace chiaro::renderer

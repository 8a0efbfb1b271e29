#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "renderer/core/error.h"
#include "renderer/image/exr_tiles.h"

namespace chiaro::test {

struct Tiling {
  int tile_width = 1, tile_height = 1;
  int first_column = 0, last_column = 0;
};

// Some columns of a cache in tiles of another size.
inline void retile(const std::filesystem::path& from, const std::filesystem::path& to, const Tiling& tiling) {
  renderer::ExrTileReader reader(from);
  renderer::ExrTiles shape = reader.shape();
  shape.tile_width = tiling.tile_width, shape.tile_height = tiling.tile_height;
  shape.first_column = tiling.first_column, shape.last_column = tiling.last_column;
  renderer::Attributes attributes = reader.attributes();
  std::erase_if(attributes, [](const auto& attribute) { return !attribute.first.starts_with("chiaro:"); });
  const std::size_t row = std::size_t(shape.last_column - shape.first_column) * shape.channels.size();
  std::vector<float> pixels(std::size_t(shape.height) * row);
  CHIARO_CHECK(reader.read(0, shape.height, shape.first_column, shape.last_column, pixels));
  renderer::ExrTileWriter writer(to, shape, attributes);
  for (int top = 0; top < shape.height; top += shape.tile_height) {
    const int tile_row = top / shape.tile_height;
    const std::size_t rows = std::size_t(shape.rows_of(tile_row));
    writer.write(tile_row, shape.first_column, shape.last_column,
                 std::span(pixels).subspan(std::size_t(top) * row, rows * row));
  }
  writer.close();
}

// All of its columns.
inline void retile(const std::filesystem::path& from, const std::filesystem::path& to, int tile_width,
                   int tile_height) {
  const renderer::ExrTiles shape = renderer::ExrTileReader(from).shape();
  retile(from, to, {tile_width, tile_height, shape.first_column, shape.last_column});
}

}  // namespace chiaro::test

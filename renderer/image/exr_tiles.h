#pragma once
// Tiled OpenEXR files of half channels that are written and read in parts: too large for memory, or little is wanted of
// them.

#include <algorithm>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "renderer/image/image_file.h"

namespace chiaro::renderer {

struct ExrTiles {
  int width = 0, height = 0;              // of the whole picture: the display window
  int first_column = 0, last_column = 0;  // what the file has of it, [first, last): the data window
  int tile_width = 1, tile_height = 1;
  std::vector<std::string> channels;  // in the order of pixels in memory; all half

  // Of a row of tiles: the last may be lower.
  int rows_of(int tile_row) const { return std::min(tile_height, height - tile_row * tile_height); }
};

// Pixels in memory: [row][column][channel].
class ExrTileWriter {
 public:
  // Begins a file. Attributes: int, float, string and three floats. Error where it cannot be written.
  ExrTileWriter(const std::filesystem::path& path, const ExrTiles& shape, const Attributes& attributes);
  ~ExrTileWriter();
  ExrTileWriter(const ExrTileWriter&) = delete;
  ExrTileWriter& operator=(const ExrTileWriter&) = delete;

  // Columns [first, last) of a row of tiles, whole tiles. Row after row, and within each from left to right. What
  // halves cannot hold is clamped. Error where the disk is full.
  void write(int tile_row, int first, int last, std::span<const float> pixels);
  void flush();  // what is written so far. Error as above
  // Before it the file is not whole. Error as above.
  void close();

 private:
  struct File;
  std::filesystem::path path_;
  ExrTiles shape_;
  std::unique_ptr<File> file_;
};

class ExrTileReader {
 public:
  static bool is_tiled(const std::filesystem::path& path);
  // Error where it is not such a file. Files that were not closed can be read as far as they go.
  explicit ExrTileReader(const std::filesystem::path& path);
  ~ExrTileReader();
  ExrTileReader(const ExrTileReader&) = delete;
  ExrTileReader& operator=(const ExrTileReader&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // Channels in alphabetical order, as OpenEXR has them.
  const ExrTiles& shape() const { return shape_; }
  const Attributes& attributes() const { return attributes_; }  // of the kinds above
  // Pixels [first, last) of rows [top, bottom), wherever tiles begin; false where any lies outside of the file's
  // columns and rows, or in a tile that is missing or damaged. Beside them it takes memory for two million pixels, or
  // for a tile where that is larger. Each call decodes anew the tiles that it touches.
  bool read(int top, int bottom, int first, int last, std::span<float> pixels);

 private:
  struct File;
  std::filesystem::path path_;
  ExrTiles shape_;
  Attributes attributes_;
  std::unique_ptr<File> file_;
};

}  // namespace chiaro::renderer

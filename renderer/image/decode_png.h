#pragma once
// PNG, through libpng itself: under OpenImageIO it prints what is wrong with a file to standard error.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace chiaro::renderer {

bool is_png(std::string_view encoded);

struct PngHeader {
  int width = 0, height = 0;
  int channels = 0;          // grey, grey and alpha, RGB or RGBA; palettes are looked up
  int bytes_per_sample = 1;  // or 2, in the order of this machine

  std::uintmax_t bytes() const { return std::uintmax_t(width) * height * channels * bytes_per_sample; }
};

// Up to the pixels. Error, naming `file`, where anything in it is wrong.
PngHeader read_png_header(std::string_view encoded, const std::string& file);

// The samples as stored, rows from the top. Error, naming `file`, where it is not whole, down to its last chunk.
std::vector<std::uint8_t> decode_png(std::string_view encoded, const std::string& file);

}  // namespace chiaro::renderer

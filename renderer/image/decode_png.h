#pragma once
// PNG, through libpng itself: under OpenImageIO it prints what is wrong with a file to standard error.

#include <string>
#include <string_view>
#include <vector>

#include "renderer/image/samples_header.h"

namespace chiaro::renderer {

bool is_png(std::string_view encoded);

// Up to the pixels. Error, naming `file`, where anything in it is wrong.
SamplesHeader read_png_header(std::string_view encoded, const std::string& file);

// The samples as stored, rows from the top. Error, naming `file`, where it is not whole, down to its last chunk.
std::vector<std::uint8_t> decode_png(std::string_view encoded, const std::string& file);

}  // namespace chiaro::renderer

#pragma once
// AVIF, through libavif itself: OpenImageIO copies as many pixels as their header says, however many there are, and keeps
// 8 bits of 10 or 12.

#include <string>
#include <string_view>
#include <vector>

#include "renderer/image/samples_header.h"

namespace chiaro::renderer {

bool is_avif(std::string_view encoded);

// RGB or RGBA, as they are stored. Error, naming `file`, where it is no AVIF with a picture, is to be cropped, or has
// colours multiplied by alpha.
SamplesHeader read_avif_header(std::string_view encoded, const std::string& file);

// Its samples, rows from the top; those of 10 and 12 bits stretched to 16. Error, naming `file`, where it is not whole.
std::vector<std::uint8_t> decode_avif(std::string_view encoded, const std::string& file);

}  // namespace chiaro::renderer

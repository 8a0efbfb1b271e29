#pragma once
// AVIF and HEIC, through libheif itself: OpenImageIO copies as many pixels as their header says, however many there
// are, and keeps 8 bits of 10 or 12.

#include <string>
#include <string_view>
#include <vector>

#include "renderer/image/samples_header.h"

namespace chiaro::renderer {

// Or another of the files that begin as they do.
bool is_heif(std::string_view encoded);

// Of the primary image, upright: RGB or RGBA. Error, naming `file`, where it is none that can be decoded, or has
// colours multiplied by alpha.
SamplesHeader read_heif_header(std::string_view encoded, const std::string& file);

// Its samples, rows from the top; those of 10 and 12 bits stretched to 16. Error, naming `file`, where it is not whole.
std::vector<std::uint8_t> decode_heif(std::string_view encoded, const std::string& file);

}  // namespace chiaro::renderer

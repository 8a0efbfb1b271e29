#pragma once
// WebP, through libwebp itself: under OpenImageIO colours are multiplied by alpha as they are stored, and cannot be
// told where that is zero.

#include <string>
#include <string_view>
#include <vector>

#include "renderer/image/samples_header.h"

namespace chiaro::renderer {

bool is_webp(std::string_view encoded);

// RGB or RGBA. Error, naming `file`, where it is none that can be decoded, or an animation.
SamplesHeader read_webp_header(std::string_view encoded, const std::string& file);

// The samples as stored, rows from the top. Error, naming `file`, where it is not whole.
std::vector<std::uint8_t> decode_webp(std::string_view encoded, const std::string& file);

}  // namespace chiaro::renderer

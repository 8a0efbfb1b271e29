#pragma once
// The formats whose samples are decoded by their own libraries.

#include <string>
#include <string_view>
#include <vector>

#include "renderer/image/samples_header.h"

namespace chiaro::renderer {

// PNG, WebP or AVIF.
bool has_samples(std::string_view encoded);

// As read_png_header and decode_png, and so on.
SamplesHeader read_samples_header(std::string_view encoded, const std::string& file);
std::vector<std::uint8_t> decode_samples(std::string_view encoded, const std::string& file);

}  // namespace chiaro::renderer

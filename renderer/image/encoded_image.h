#pragma once
// What can be told about an encoded image without decoding it.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace chiaro::renderer {

// What is wrong with a JPEG whose bytes are not all there or not all right; absent where nothing is, and for other
// formats. Its decoder fills with grey where this speaks.
std::optional<std::string> find_jpeg_damage(std::string_view encoded);

// Whether a file of `file_bytes` may hold so many bytes of pixels. No picture of any use is packed tighter, but for
// those that memory has room for anyway.
bool may_hold(std::uintmax_t file_bytes, std::uintmax_t pixel_bytes);

}  // namespace chiaro::renderer

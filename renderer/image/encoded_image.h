#pragma once
// What can be told about an encoded image without decoding it.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace chiaro::renderer {

// What is wrong with a PNG or JPEG whose bytes are not all there or not all right; absent where nothing is, and for
// other formats. Decoders of both print to standard error, or fill with grey, where this speaks.
std::optional<std::string> find_damage(std::string_view encoded);

// Whether a file of `file_bytes` may hold so many bytes of pixels. No picture of any use is packed tighter, but for
// those that memory has room for anyway.
bool may_hold(std::uintmax_t file_bytes, std::uintmax_t pixel_bytes);

}  // namespace chiaro::renderer

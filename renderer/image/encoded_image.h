#pragma once
// What can be told about an encoded image without decoding it.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace chiaro::renderer {

// Whether a file with these first bytes is a JPEG.
bool is_jpeg(std::string_view first_bytes);

// What is wrong with a JPEG whose bytes are not all there or not all right, whose decoder fills with grey what is not
// there, or with a BMP whose header is of no kind that there is, which OpenImageIO takes without having read it. Absent
// where nothing is, and for other formats. Of a BMP the first 18 bytes are enough.
std::optional<std::string> find_damage(std::string_view encoded);

// Whether a file of `file_bytes` may hold so many bytes of pixels. No picture of any use is packed tighter, but for
// those that memory has room for anyway.
bool may_hold(std::uintmax_t file_bytes, std::uintmax_t pixel_bytes);

}  // namespace chiaro::renderer

#pragma once
// What can be told about an encoded image without decoding it.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace chiaro::renderer {

// So many of its first bytes say which format a picture has, and what there is to find_damage() but of a JPEG.
constexpr std::size_t kFormatBytes = 8192;

// The format that a picture with these first bytes has, by OpenImageIO's name of it; empty: none that is read here.
// Formats without a signature are told by the name's extension (".tga"), and so is what a file of another content was
// meant to be.
std::string_view format_of(std::string_view first_bytes, const std::filesystem::path& name = {});

// What is wrong with a picture of that format that its reader takes nevertheless: a JPEG whose bytes are not all there
// or not all right, filled up with grey; a TGA with a palette, whose pixels may refer to colours beyond it, with fewer
// bits than colours take, or with its lines out of order; a PNM that is text, or whose largest sample is not as large as
// its reader takes. Absent where nothing is, and for other formats. Of a JPEG it takes all bytes, of others the first.
std::optional<std::string> find_damage(std::string_view format, std::string_view bytes);

// Whether what a reader says of pixels that it has read, if anything, is that they are not right. Of JPEGs it says much
// that is harmless.
bool tells_damage(std::string_view format, std::string_view message);

// Whether a file of `file_bytes` may hold so many bytes of pixels. No picture of any use is packed tighter, but for
// those that memory has room for anyway.
bool may_hold(std::uintmax_t file_bytes, std::uintmax_t pixel_bytes);

}  // namespace chiaro::renderer

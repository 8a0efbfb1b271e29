#pragma once
// What can be told about an encoded image without decoding it.

#include <optional>
#include <string>
#include <string_view>

namespace chiaro::renderer {

// What is wrong with a PNG or JPEG whose bytes are not all there or not all right; absent where nothing is, and for
// other formats. Decoders of both print to standard error, or fill with grey, where this speaks.
std::optional<std::string> find_damage(std::string_view encoded);

}  // namespace chiaro::renderer

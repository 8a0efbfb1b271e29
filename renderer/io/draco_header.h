#pragma once
// The first fields of a Draco bitstream, which say how large it becomes.

#include <cstdint>
#include <optional>
#include <string_view>

namespace chiaro::renderer {

// The number of triangles that a compressed mesh says it has; absent where it is not a mesh or is cut off before that.
// Source: Google, Draco Bitstream Specification, version 2.2, 2018, sections "Draco Decoder" and "Connectivity".
std::optional<std::uint64_t> draco_face_count(std::string_view bytes);

}  // namespace chiaro::renderer

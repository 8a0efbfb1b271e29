#pragma once
// The first fields of a Draco bitstream, which say how large it becomes.

#include <cstdint>
#include <optional>
#include <string_view>

namespace chiaro::renderer {

struct DracoSizes {
  std::uint64_t faces = 0;
  std::uint64_t points = 0;  // that stand by themselves; 0 where they follow from the faces
};

// What a compressed mesh says it has; absent where it is not a mesh or is cut off before that.
// Source: Google, Draco Bitstream Specification, version 2.2, 2018, sections "Draco Decoder" and "Connectivity".
std::optional<DracoSizes> draco_sizes(std::string_view bytes);

}  // namespace chiaro::renderer

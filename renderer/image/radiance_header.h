#pragma once
// What the header of a Radiance picture (.hdr, .pic) says of its values, of which OpenImageIO reads the least.
// Source: Radiance, File Formats (G. Ward), "Picture File Format".

#include <array>
#include <filesystem>
#include <optional>

#include "renderer/core/vec.h"

namespace chiaro::renderer {

struct RadianceHeader {
  Vec3f multiplied{1, 1, 1};  // that the pixels have been multiplied with: all EXPOSURE and COLORCORR together
  std::optional<std::array<float, 8>> chromaticities;  // PRIMARIES: red, green, blue, white, x and y each
};

// Error where a factor is not positive, primaries are not eight numbers, or pixels are on a curve (GAMMA).
RadianceHeader read_radiance_header(const std::filesystem::path& path);

}  // namespace chiaro::renderer

#pragma once

#include <array>
#include <optional>

namespace chiaro::renderer {

// Row by row: Rec.709 = matrix × colour of the space.
using Rec709FromSpace = std::array<std::array<double, 3>, 3>;

// CIE xy chromaticities (red, green, blue, white) of the RGB space in use whose matrix this is, white adapted to D65 by
// the Bradford transform as colour configs do; absent for others. The matrix alone does not tell a space's own white.
std::optional<std::array<float, 8>> known_chromaticities(const Rec709FromSpace& matrix);

// The matrix of the space of these chromaticities, its white adapted to D65 by the Bradford transform. Not finite where
// they span no colours.
Rec709FromSpace rec709_from_chromaticities(const std::array<float, 8>& chromaticities);

}  // namespace chiaro::renderer

#pragma once

#include <optional>

#include "renderer/image/image.h"

namespace chiaro::renderer {

// Display-referred R, G, B of one size, and the FLIP of each pixel (one channel).
struct ComparisonPanels {
  Image a, b, difference;
  std::optional<Image> flip;
};

// |A − B| × 8 of R, G, B; what is no number becomes 1.
Image magnified_difference(const Image& a, const Image& b);

// A and B, below them their difference and FLIP as a heat map with its scale, each with its name underneath.
Image comparison_picture(const ComparisonPanels& panels);

}  // namespace chiaro::renderer

#pragma once
// A few letters, five by seven pixels each, for pictures that explain themselves.

#include <string_view>

#include "renderer/image/image.h"

namespace chiaro::renderer {

inline constexpr int kTextHeight = 7;  // pixels, times the scale

// Pixels across, the space after the last letter included.
int text_width(std::string_view text, int scale);

// Draws white letters with their top left corner at (left, top); what lies outside is left out. Letters: 0 1 8 . - |
// x A B F I L P; others are blank.
void draw_text(std::string_view text, int left, int top, int scale, Image& picture);

}  // namespace chiaro::renderer

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/view_options.h"
#include "renderer/image/image.h"

namespace chiaro::cli {

// Two frames made comparable: R, G, B of one size, both scene-linear Rec.709 or both display-referred.
struct ComparedFrames {
  renderer::Image a, b;
  bool scene_linear = false;
  bool by_view = false;            // either was scene-linear, so that the view decides what is seen of it
  std::optional<float> exposure;   // EV that the view showed one of them at, which is scene-linear
  std::vector<std::string> notes;  // what they differ in besides their pixels, and what was done about it
};

// Files of floats are scene-linear, of whole numbers display-referred; where the two differ in that, the view shows the
// former. Error where the sizes differ, unless A is to be resized.
ComparedFrames load_compared_frames(const std::string& a, const std::string& b, const ViewChoice& view, bool resize);

}  // namespace chiaro::cli

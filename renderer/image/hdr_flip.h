#pragma once
// Source: Andersson, Nilsson, Shirley, Akenine-Möller, Visualizing Errors in Rendered High Dynamic Range Images, 2021.

#include "renderer/core/control.h"
#include "renderer/image/flip.h"

namespace chiaro::renderer {

struct HdrFlip {
  Image error;                 // of each pixel the largest over all exposures, as flip() gives it
  double start = 0, stop = 0;  // EV of the first and the last exposure
  int exposures = 0;
};

// FLIP of scene-linear R, G, B (Rec.709) of one size, over exposures chosen from the reference: from where its
// brightest pixel shows at 0.85 of the display's range to where its median does, an EV apart or less, through the
// published tone mapping. Of a reference mostly black the median is that of the rest; of one that is all black
// `a` takes its place. What is below 0 or not finite counts as 0.
HdrFlip hdr_flip(const Image& a, const Image& reference, double pixels_per_degree = kPixelsPerDegree,
                 const Control& control = {});

}  // namespace chiaro::renderer

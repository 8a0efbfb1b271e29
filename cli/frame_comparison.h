#pragma once
// What `compare` finds out about two frames.

#include <optional>
#include <string>
#include <vector>

#include "cli/compared_frames.h"
#include "renderer/image/compare_images.h"
#include "renderer/image/comparison_picture.h"
#include "renderer/image/hdr_flip.h"

namespace chiaro::cli {

struct NamedRegion {
  std::string name;
  renderer::PixelRegion pixels;
};

// "x0,y0,x1,y1" or "NAME=x0,y0,x1,y1". UsageError where there are no pixels in it.
NamedRegion parse_region(const std::string& text);

struct FrameFigures {
  renderer::ImageComparison image;
  std::optional<double> flip, flip_hdr;  // means over pixels that are finite in both frames
};

struct FrameComparison {
  bool scene_linear = false;
  FrameFigures whole;
  std::vector<NamedRegion> regions;
  std::vector<FrameFigures> of_regions;
  std::optional<float> exposure;  // EV that the view showed scene-linear frames at
  renderer::HdrFlip hdr_flip;     // of scene-linear frames
  renderer::ComparisonPanels panels;
};

struct FrameComparisonOptions {
  ViewChoice view;
  std::vector<NamedRegion> regions;
  double pixels_per_degree = renderer::kPixelsPerDegree;
  bool no_flip = false;
  bool picture = true;  // panels are wanted; without them, and without FLIP, no view is needed
};

// PSNR is against the largest value of B where both are scene-linear, else against 1, the display's white. FLIP is that
// of the frames as the view shows them; an automatic exposure is that of B.
FrameComparison compare_frames(const ComparedFrames& frames, const FrameComparisonOptions& options,
                               const renderer::Control& control);

}  // namespace chiaro::cli

#pragma once
// Pictures that somebody painted, as wanted illumination of the surfaces that they show.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "inverse/target/target_from_values.h"
#include "renderer/image/image.h"
#include "renderer/trace/ray_tracer.h"

namespace chiaro::inverse {

enum class PictureContent : std::uint8_t {
  kBeauty,        // the surfaces' colours are in it: they are divided out
  kIllumination,  // of white surfaces
};

struct PaintedFrame {
  renderer::Camera camera;
  int width = 0, height = 0;
  std::vector<Vec3f> pixels;  // scene-linear Rec.709, cd/m², rows from the top
  std::vector<float> weight;  // per pixel, 0 to 1: how much it counts
  PictureContent content = PictureContent::kBeauty;
};

// What became of the pixels. All but `used` weigh nothing.
struct PixelCounts {
  std::size_t used = 0;
  std::size_t masked = 0;      // weight 0 already
  std::size_t background = 0;  // no surface
  std::size_t edge = 0;        // more than one surface
  std::size_t shiny = 0;       // emits, transmits, or reflects like a mirror: not its illumination
  std::size_t dark = 0;        // of a surface too dark to tell its illumination
  std::size_t invalid = 0;     // not finite, or negative
};

struct FrameValues {
  std::vector<SurfaceValue> values;  // of the pixels used
  PixelCounts counts;
};

// One value for every pixel that shows one matt surface, where the camera sees it; its weight is the pixel's. Beauty is
// divided by hemispherical albedo averaged over the pixel.
FrameValues values_of_frame(const renderer::RayTracer& tracer, const PaintedFrame& frame,
                            const renderer::Control& control = {});

}  // namespace chiaro::inverse

#pragma once
// Final frames.

#include <optional>
#include <string>
#include <vector>

#include "renderer/image/image.h"
#include "renderer/trace/camera_rays.h"
#include "renderer/trace/cryptomatte.h"
#include "renderer/trace/trace_illumination.h"

namespace chiaro::renderer {

struct RenderOptions {
  int width = 960, height = 540;
  TraceOptions trace{.samples = 64};  // samples: the most of a pixel
  double time_limit = 0;              // seconds; 0: none. Passes go on until it is spent
  double noise_threshold = 0;         // error at which a tile needs no more samples, see adaptive_sampling.h; 0: none
  // Most of a sample's contribution by one light on one surface, cd/m². Bias for less noise: off unless asked for.
  float clamp_direct = kInfinity, clamp_indirect = kInfinity;
  bool box_filter = false;  // 1-pixel box instead of Blackman–Harris, 1.5 pixels radius
  Lens lens{};
  std::vector<std::string> layers;  // of frame_layers()
};

// albedo, normal, position, depth, direct, indirect, illumination, variance (of the pixel's mean), samples (of the
// pixel), lights (one `light.NAME` layer per light), cryptomatte (of objects and materials).
const std::vector<std::string>& frame_layers();

struct Frame {
  Image image;              // R, G, B in cd/m², A, then the layers as LAYER.R …
  int samples = 0;          // of the pixel that has the most
  double mean_samples = 0;  // per pixel
  double seconds = 0;
  std::optional<double> relative_standard_error;  // of the pixels, sqrt(Σ se² / Σ value²); absent: not known
  std::uint64_t dropped_samples = 0;              // that were not finite, and were left black
  bool interrupted = false;   // asked to stop before it was done; every pixel has samples all the same
  Lens lens;                  // as rendered with
  std::vector<Matte> mattes;  // of the cryptomatte layer
};

// The frame that `camera` sees under `lights` and the scene's emissive surfaces. Asked to stop, it gives what it has;
// Interruption where some pixel has no sample yet.
Frame render(const RayTracer& tracer, const Camera& camera, const Lights& lights, const RenderOptions& options,
             const Control& control = {});

// A camera that sees the whole scene in frames of this shape, width over height, for scenes without one.
Camera default_camera(const Scene& scene, float aspect_ratio = 1);

}  // namespace chiaro::renderer

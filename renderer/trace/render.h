#pragma once
// Final frames.

#include <string>
#include <vector>

#include "renderer/image/image.h"
#include "renderer/trace/trace_illumination.h"

namespace chiaro::renderer {

struct RenderOptions {
  int width = 960, height = 540;
  TraceOptions trace{.samples = 64};
  double time_limit = 0;            // seconds; 0: none. Passes go on until it is spent, `samples` is then the most
  bool box_filter = false;          // 1-pixel box instead of Blackman–Harris, 1.5 pixels radius
  std::vector<std::string> layers;  // of kFrameLayers
};

// albedo, normal, position, depth, direct, indirect, illumination, variance, lights (one `light.NAME` layer per light).
const std::vector<std::string>& frame_layers();

struct Frame {
  Image image;      // R, G, B in cd/m², A, then the layers as LAYER.R …
  int samples = 0;  // per pixel, taken
  double seconds = 0;
  double relative_standard_error = 0;  // of the mean of the frame's pixels, sqrt(Σ se² / Σ value²)
};

// The frame that `camera` sees under `lights` and the scene's emissive surfaces.
Frame render(const RayTracer& tracer, const Camera& camera, const Lights& lights, const RenderOptions& options,
             const Control& control = {});

// A camera that sees the whole scene, for scenes without one.
Camera default_camera(const Scene& scene);

}  // namespace chiaro::renderer

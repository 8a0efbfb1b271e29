#pragma once

#include <optional>

#include "renderer/trace/camera_rays.h"

namespace CLI {
class App;
}

namespace chiaro::cli {

// --f-number, --focus-distance, --focal-length, --sensor-height, --blades: the lens of the camera, which glTF has not.
struct LensOptions {
  std::optional<float> f_number;        // absent: a pinhole
  std::optional<float> focus_distance;  // metres; absent: what the middle of the frame shows
  std::optional<float> focal_length;    // millimetres; absent: from the camera's field and the sensor's height
  float sensor_height = 24;             // millimetres, of 35 mm film
  int blades = 0;                       // of the aperture; 0: round
};

void add_lens_options(CLI::App& command, LensOptions& options);

// UsageError where an orthographic camera has no focal length.
renderer::Lens lens_of(const LensOptions& options, const renderer::Camera& camera, const renderer::RayTracer& tracer);

}  // namespace chiaro::cli

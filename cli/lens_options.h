#pragma once

#include <optional>

#include "renderer/trace/camera_rays.h"

namespace CLI {
class App;
}

namespace chiaro::cli {

// --f-number, --focus-distance, --focal-length, --sensor-height, --blades, --shutter, --iso: what glTF's cameras have
// not.
struct LensOptions {
  std::optional<float> f_number;        // absent: a pinhole
  std::optional<float> focus_distance;  // metres; absent: what the middle of the frame shows
  std::optional<float> focal_length;    // millimetres; absent: from the camera's field and the sensor's height
  float sensor_height = 24;             // millimetres, of 35 mm film
  int blades = 0;                       // of the aperture; 0: round
  std::optional<float> shutter;         // seconds; absent: display pictures are not exposed as a camera does
  float iso = 100;
};

// Stops that display pictures are exposed by: what saturates the film is shown as scene-linear 1. 0 without a shutter.
// Source: ISO 12232, saturation-based speed: 78 / (ISO · 0.65) lux seconds per f-number squared, cd/m².
float camera_exposure(const LensOptions& options);

void add_lens_options(CLI::App& command, LensOptions& options);

// UsageError where an orthographic camera has no focal length.
void require_lens(const LensOptions& options, const renderer::Camera& camera);

// What require_lens() asks is so.
renderer::Lens lens_of(const LensOptions& options, const renderer::Camera& camera, const renderer::RayTracer& tracer);

}  // namespace chiaro::cli

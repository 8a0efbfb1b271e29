#include "cli/lens_options.h"

#include <cmath>

#include <CLI/CLI.hpp>

#include "cli/add_options.h"
#include "cli/usage_error.h"

namespace chiaro::cli {
namespace {

constexpr CountRange kBlades{3, 64};
constexpr NumberRange kFNumbers{.min = 0.01, .max = 1e4};
constexpr NumberRange kLengths{.min = 1e-3, .max = 1e6};  // millimetres, or metres
constexpr float kAllSharp = 1e6F;                         // metres

float focal_length(const LensOptions& options, const renderer::Camera& camera) {
  if (options.focal_length) return *options.focal_length;
  if (camera.orthographic) {
    throw UsageError("--f-number: an orthographic camera has no focal length (expected --focal-length too)");
  }
  return 0.5F * options.sensor_height / std::tan(0.5F * camera.vertical_fov);
}

float distance_in_the_middle(const renderer::Camera& camera, const renderer::RayTracer& tracer) {
  renderer::Ray ray = renderer::CameraRays(camera, 2, 2).at({1, 1});
  ray.of_camera = true;
  // Of half-transparent surfaces, which some rays pass, what most of them meet.
  constexpr std::size_t kRays = 31;
  std::vector<float> distances;
  for (std::uint32_t seed = 0; seed < kRays; ++seed) {
    ray.alpha_seed = seed;
    const auto hit = tracer.intersect(ray);
    distances.push_back(hit ? hit->distance : kAllSharp);
  }
  std::nth_element(distances.begin(), distances.begin() + kRays / 2, distances.end());
  return distances[kRays / 2];
}

}  // namespace

float camera_exposure(const LensOptions& options) {
  if (!options.f_number || !options.shutter) return 0;
  constexpr float kSaturation = 78 / 0.65F;
  const float brightest = kSaturation * *options.f_number * *options.f_number / (*options.shutter * options.iso);
  return -std::log2(brightest);
}

void add_lens_options(CLI::App& command, LensOptions& options) {
  CLI::Option* f_number =
      add_number(command, {"--f-number", "N", "Depth of field of a lens of this f-number (default: all is sharp)"},
                 options.f_number, kFNumbers);
  const auto add = [&](const OptionText& text, auto& value) {
    add_number(command, text, value, kLengths)->needs(f_number);
  };
  add({"--focus-distance", "M", "Metres to what is sharp (default: to what the frame's middle shows)"},
      options.focus_distance);
  add({"--focal-length", "MM", "Of the lens (default: by the camera's field); the field stays the camera's"},
      options.focal_length);
  add({"--sensor-height", "MM", "Of the film, which the focal length follows from (default 24)"},
      options.sensor_height);
  add_count(command, {"--blades", "N", "Blades of the aperture (default: round)"}, options.blades, kBlades)
      ->needs(f_number);
  CLI::Option* shutter =
      add_number(command, {"--shutter", "SECONDS", "Expose display pictures as a camera does; --exposure adds to it"},
                 options.shutter, kPositive)
          ->needs(f_number);
  add_number(command, {"--iso", "N", "Speed of the film (default 100)"}, options.iso, kPositive)->needs(shutter);
}

void require_lens(const LensOptions& options, const renderer::Camera& camera) {
  if (options.f_number) focal_length(options, camera);
}

renderer::Lens lens_of(const LensOptions& options, const renderer::Camera& camera, const renderer::RayTracer& tracer) {
  if (!options.f_number) return {};
  constexpr float kMetres = 1e-3F;
  return {.radius = 0.5F * kMetres * focal_length(options, camera) / *options.f_number,
          .focus_distance = options.focus_distance ? *options.focus_distance : distance_in_the_middle(camera, tracer),
          .blades = options.blades};
}

}  // namespace chiaro::cli

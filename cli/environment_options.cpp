#include "cli/environment_options.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/add_options.h"
#include "renderer/core/error.h"
#include "renderer/core/world_limits.h"
#include "renderer/io/environment_file.h"

namespace chiaro::cli {
namespace {

constexpr float kRadiansPerDegree = renderer::kPi / 180;

void apply(const EnvironmentOptions& options, renderer::Lights& lights) {
  bool found = false;
  for (renderer::Light& light : lights) {
    auto* environment = std::get_if<renderer::EnvironmentLight>(&light);
    if (environment == nullptr) continue;
    found = true;
    if (options.rotation) environment->rotation = *options.rotation * kRadiansPerDegree;
    if (options.intensity) environment->intensity = *options.intensity;
  }
  if (!found && (options.rotation || options.intensity)) {
    throw renderer::Error({"", options.rotation ? "option --environment-rotation" : "option --environment-intensity",
                           "there is no environment", "--environment, or a scene or light file with one"});
  }
}

// Its brightest pixel, times its intensity.
void require_no_brighter_than_may_be(const renderer::EnvironmentLight& light) {
  float brightest = 0;
  for (const renderer::Vec3f& pixel : light.map->pixels) brightest = std::max(brightest, max_component(pixel));
  const double luminance = double(light.intensity) * double(brightest);
  if (luminance <= double(renderer::kBrightest)) return;
  throw renderer::Error(
      {light.image, fmt::format("environment \"{}\"", light.name),
       fmt::format("is too bright: {:g} cd/m², times an intensity of {:g}", brightest, light.intensity),
       fmt::format("at most {:g} cd/m² in all", renderer::kBrightest)});
}

}  // namespace

void add_environment_options(CLI::App& command, EnvironmentOptions& options) {
  add_input_file(
      command,
      {"--environment", "IMAGE",
       "Light from all around (.exr, .hdr …; latitude-longitude, top +Y, middle +X, a quarter from the left -Z)"},
      options.image);
  add_number(
      command,
      {"--environment-rotation", "DEGREES", "About +Y, to the left as seen from within: 90 turns -Z to -X (default 0)"},
      options.rotation, {-360, 360});
  add_number(command, {"--environment-intensity", "FACTOR", "cd/m² of a pixel of 1 (default 1)"}, options.intensity,
             {0, 1e15});
}

EnvironmentOptions in_config(EnvironmentOptions options, const std::optional<std::filesystem::path>& config) {
  options.config = config;
  return options;
}

renderer::Lights with_environment(renderer::Lights lights, const EnvironmentOptions& options,
                                  std::vector<std::string>& warnings) {
  if (!options.image.empty()) {
    std::erase_if(lights, renderer::is_environment);
    lights.emplace_back(renderer::load_environment(options.image, warnings, options.config));
  }
  apply(options, lights);
  for (const renderer::Light& light : lights) {
    if (const auto* environment = std::get_if<renderer::EnvironmentLight>(&light)) {
      require_no_brighter_than_may_be(*environment);
    }
  }
  return lights;
}

}  // namespace chiaro::cli

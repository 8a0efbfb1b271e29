#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/light.h"

namespace CLI {
class App;
}

namespace chiaro::cli {

// --environment, --environment-rotation and --environment-intensity.
struct EnvironmentOptions {
  std::string image;              // empty: the scene's own, if it has one
  std::optional<float> rotation;  // degrees
  std::optional<float> intensity;
  std::optional<std::filesystem::path> config;  // of OpenColorIO, for images that name a colour space of it
};

void add_environment_options(CLI::App& command, EnvironmentOptions& options);

// The options with the config of --ocio.
EnvironmentOptions in_config(EnvironmentOptions options, const std::optional<std::filesystem::path>& config);

// `lights` with the environment asked for in place of theirs, or theirs turned and dimmed as asked for. Error for an
// image that cannot be read, and where there is no environment to turn or dim.
renderer::Lights with_environment(renderer::Lights lights, const EnvironmentOptions& options,
                                  std::vector<std::string>& warnings);

}  // namespace chiaro::cli

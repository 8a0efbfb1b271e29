#pragma once

#include <string>
#include <vector>

#include "renderer/io/load_gltf.h"

namespace CLI {
class App;
}

namespace chiaro::cli {

// What every command that loads a scene has.
void add_scene_options(CLI::App& command, renderer::LoadOptions& options);
std::vector<std::string> scene_option_names();

}  // namespace chiaro::cli

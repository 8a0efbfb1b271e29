#pragma once

#include "renderer/io/load_gltf.h"

namespace CLI {
class App;
}

namespace chiaro::cli {

// What every command that loads a scene has: --variant, --animation, --animation-time, --allow-external.
void add_scene_options(CLI::App& command, renderer::LoadOptions& options);

}  // namespace chiaro::cli

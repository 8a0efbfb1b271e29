#pragma once

#include <optional>
#include <string>

#include "renderer/scene/material_override.h"

namespace CLI {
class App;
}

namespace chiaro::cli {

// --materials and --albedo, and --hide-backs.
struct MaterialOptions {
  std::optional<renderer::MaterialModel> model;  // as given
  std::optional<renderer::Vec3f> albedo;
  bool hide_backs = false;
};

void add_material_options(CLI::App& command, MaterialOptions& options);

// --hide-backs, of commands that make frames or read them.
void add_hide_backs(CLI::App& command, MaterialOptions& options);

renderer::MaterialOverride material_override(const MaterialOptions& options);

// "gltf", "diffuse" or "albedo R,G,B": how caches and frames name it.
std::string text_of_materials(const MaterialOptions& options);

}  // namespace chiaro::cli

#pragma once
// glTF 2.0 scenes, through tinygltf.

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/scene/light.h"
#include "renderer/scene/scene.h"

namespace chiaro::renderer {

struct LoadOptions {
  std::string variant;  // of KHR_materials_variants; empty: the materials that primitives have of their own
};

struct LoadedScene {
  Scene scene;
  Lights lights;                      // KHR_lights_punctual, in world space; last EXT_lights_image_based
  std::vector<std::string> variants;  // names, of KHR_materials_variants
  std::vector<std::string> warnings;  // one line each, what was left out or repaired
};

// Loads .glb or .gltf: node hierarchies (the default scene; with none, every root node), instances, cameras,
// metallic-roughness materials with textures, vertex colours, alpha, emission, KHR_lights_punctual,
// the KHR_materials_* extensions of gltf_extensions.cpp, KHR_texture_transform. Triangles of zero area are dropped.
// Error, naming the file and the place, for what is not a glTF, out-of-range indices, truncated buffers, positions that
// are not finite, cycles among nodes, a variant that the file does not have, or an extension under extensionsRequired
// that is not read here.
LoadedScene load_gltf(const std::filesystem::path& path, const LoadOptions& options = {});

}  // namespace chiaro::renderer

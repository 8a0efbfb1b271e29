#pragma once
// glTF 2.0 scenes, through tinygltf.

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/scene/light.h"
#include "renderer/scene/scene.h"

namespace chiaro::renderer {

struct LoadedScene {
  Scene scene;
  Lights lights;                      // KHR_lights_punctual, in world space; last EXT_lights_image_based
  std::vector<std::string> warnings;  // one line each, what was left out or repaired
};

// Loads .glb or .gltf: node hierarchies (the default scene; with none, every root node), instances, cameras,
// metallic-roughness materials with textures, vertex colours, alpha, emission, KHR_lights_punctual,
// KHR_materials_emissive_strength. Triangles of zero area are dropped.
// Error, naming the file and the place, for what is not a glTF, out-of-range indices, truncated buffers, positions that
// are not finite, cycles among nodes, or an extension under extensionsRequired that is not read here.
LoadedScene load_gltf(const std::filesystem::path& path);

}  // namespace chiaro::renderer

#pragma once
// glTF 2.0 scenes, through tinygltf.

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/core/control.h"
#include "renderer/io/gltf_animation.h"
#include "renderer/scene/light.h"
#include "renderer/scene/scene.h"

namespace chiaro::renderer {

struct LoadOptions {
  AnimationChoice animation = {};
  std::string variant = {};  // of KHR_materials_variants; empty: the materials that primitives have of their own
  ExternalFiles external = ExternalFiles::kInFolder;
};

struct LoadedScene {
  Scene scene;
  Lights lights;                      // KHR_lights_punctual, in world space; last EXT_lights_image_based
  std::vector<int> light_nodes;       // of the punctual lights, which come first
  std::vector<std::string> variants;  // names, of KHR_materials_variants
  std::vector<std::string> warnings;  // one line each, naming the file: what was left out or repaired
};

// Loads .glb or .gltf: node hierarchies (of the file's scene, or the first where it names none), instances, cameras,
// skins and morph targets (as the nodes stand, or at the time of an animation), metallic-roughness materials with
// textures, the KHR_materials_* extensions of gltf_extensions.cpp, KHR_texture_transform, vertex colours, alpha,
// emission, KHR_lights_punctual, Draco and meshoptimizer compression. Skinned meshes are in world space. Triangles of
// zero area are dropped; tangents are made for normal maps. Error, naming the file and the place, for what is not a
// glTF, out-of-range indices, truncated buffers, positions that are not finite, cycles among nodes, a variant that the
// file does not have, an extension under extensionsRequired that is not read here, or surfaces too small or too far from
// the origin for floats. control: to be interrupted.
LoadedScene load_gltf(const std::filesystem::path& path, const LoadOptions& options = {}, const Control& control = {});

}  // namespace chiaro::renderer

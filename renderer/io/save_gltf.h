#pragma once

#include <filesystem>
#include <vector>

#include "renderer/core/external_files.h"
#include "renderer/scene/light.h"

namespace chiaro::renderer {

struct AddLightsOptions {
  bool keep_lights = false;  // lights already in the scene stay; otherwise they are taken out
  // Nodes whose lights stay theirs, wherever those lead them, and shine as the lights given: as many; empty: none is.
  std::vector<int> relit_nodes{};
  ExternalFiles external = ExternalFiles::kInFolder;  // that the scene may embed
};

// Writes `scene_path` (.glb or .gltf) as `path` (.glb, or .gltf with data embedded) with KHR_lights_punctual nodes for
// `lights` added at the root of its default scene, or with relit_nodes in their place. All else in the file — meshes,
// images, extensions unknown to us — is kept as it is; external buffers and images are embedded. Error for
// environments, which the extension has none of.
void save_gltf_with_lights(const std::filesystem::path& scene_path, const Lights& lights,
                           const std::filesystem::path& path, const AddLightsOptions& options);

}  // namespace chiaro::renderer

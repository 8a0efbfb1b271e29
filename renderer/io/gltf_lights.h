#pragma once
// KHR_lights_punctual and cameras: what a node points at, placed in the world.

#include <string>
#include <vector>

#include "renderer/io/gltf_nodes.h"
#include "renderer/scene/light.h"
#include "renderer/scene/scene.h"

namespace chiaro::renderer {

// One light per node that has one. Named as the node, or else as the light. A node's scale changes nothing but where
// its children are; `range` is ignored, as light does not end.
struct NodeLights {
  Lights lights;
  std::vector<int> nodes;  // of each
};
NodeLights read_lights(const GltfDocument& document, const std::vector<PlacedNode>& nodes,
                       std::vector<std::string>& warnings);

// One camera per node that has one, world_from_camera without scale.
std::vector<Camera> read_cameras(const GltfDocument& document, const std::vector<PlacedNode>& nodes);

}  // namespace chiaro::renderer

#pragma once
// The meshes that the nodes of a glTF file show.

#include <optional>
#include <vector>

#include "renderer/io/gltf_document.h"
#include "renderer/io/gltf_nodes.h"
#include "renderer/io/gltf_primitives.h"
#include "renderer/io/mesh_repair.h"

namespace chiaro::renderer {

// A primitive in the shape that a node gives it.
struct PosedPrimitive {
  Mesh mesh;
  bool in_world = false;                // moved by a skin, which leaves the node's own transform out
  std::size_t mended_skin_weights = 0;  // vertices
};

// With its morph targets by their weights, and moved by the skin whose world_from_bind is given, if any. Not repaired.
// Absent where read_primitive is.
std::optional<PosedPrimitive> read_posed_primitive(const GltfDocument& document, const GltfPrimitiveRef& ref,
                                                   const std::vector<float>& weights,
                                                   const std::vector<Mat4f>* world_from_bind);

// Indices into Scene::meshes, one per primitive that has triangles.
struct NodeMeshes {
  std::vector<int> in_node;   // in the space of the node
  std::vector<int> in_world;  // moved by a skin, which leaves the node's own transform out
};

struct NodeMeshList {
  std::vector<NodeMeshes> of_node;  // as the nodes given
  MeshRepairs repairs;
  std::size_t without_triangles = 0;  // primitives
};

// How the nodes stand and what they wear.
struct NodeState {
  std::vector<Mat4f> world_from_nodes;
  int variant = -1;  // of KHR_materials_variants; -1: none
};

Material default_material();

// Reads what the nodes show into scene.meshes, repaired, with morph targets and skins applied and tangents made where
// the material has a normal map. Nodes share what is the same mesh with the same skin and weights. Primitives without a
// material get a default one, which is added to the materials. On all threads, in the order of the nodes.
NodeMeshList read_node_meshes(const GltfDocument& document, const std::vector<PlacedNode>& nodes,
                              const NodeState& state, Scene& scene);

// One of the scene's meshes, moved by a transform that need not have an inverse. Absent where no area is left.
std::optional<Mesh> mesh_in_world(const Scene& scene, int index, const Mat4f& world_from_object);

}  // namespace chiaro::renderer

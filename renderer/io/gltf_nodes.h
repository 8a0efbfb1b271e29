#pragma once
// The node hierarchy, flattened.

#include <string>
#include <vector>

#include "renderer/core/vec.h"
#include "renderer/io/gltf_animation.h"
#include "renderer/io/gltf_document.h"

namespace chiaro::renderer {

struct PlacedNode {
  int node = 0;      // index into the file's nodes
  int parent = -1;   // the same; -1: none
  std::string name;  // of the node; may be empty
  int mesh = -1, camera = -1, light = -1, skin = -1;
  std::vector<float> weights;  // of its mesh's morph targets
  Mat4f world_from_node;
};

// World transforms of all nodes of the file in a pose, whatever scene they are in. Error for cycles, nodes with two
// parents, and for transforms that are not finite, of a projection or of no direction.
std::vector<Mat4f> world_from_nodes(const GltfDocument& document, const GltfPose& pose = {});

// The visible nodes of the scene that is shown, or of a file without scenes, parents before children.
// Error as world_from_nodes.
std::vector<PlacedNode> place_nodes(const GltfDocument& document, const GltfPose& pose = {});

// "nodes[3]"
std::string place_of(const PlacedNode& node);

// Error, naming the place, where the fourth row of a matrix, which comes column after column, is that of a projection:
// transposed ones have their translation there.
void check_affine(const GltfDocument& document, const std::vector<double>& matrix, double tolerance,
                  const std::string& place);

// Error, naming the node, for a point of it that is beyond the world's limits. `what`: "a vertex", "a light", …
void check_in_world(const GltfDocument& document, const PlacedNode& node, Vec3f point, const char* what);

// EXT_mesh_gpu_instancing: the node's transforms of each copy of its mesh; one, the node's own, without it.
std::vector<Mat4f> instance_transforms(const GltfDocument& document, const PlacedNode& node);

}  // namespace chiaro::renderer

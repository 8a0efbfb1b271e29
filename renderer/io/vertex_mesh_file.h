#pragma once
// Meshes that carry illumination per vertex: receivers and targets, as .glb or .gltf in world space.

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace chiaro::renderer {

struct VertexMeshPart {
  std::string name;  // of the node
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;  // unit
  std::vector<Triangle> triangles;
  // Empty, or one per vertex:
  std::vector<Vec3f> illumination;    // _ILLUMINATION, cd/m²
  std::vector<float> weight;          // _WEIGHT
  std::vector<float> standard_error;  // _STANDARD_ERROR, cd/m²
  std::vector<Vec3f> color;           // COLOR_0, linear; read only
};

struct VertexMesh {
  std::vector<VertexMeshPart> parts;
  std::vector<std::string> warnings = {};  // one line each, naming the file: what was left out in reading
};

// One part per primitive and instance, in the order and at the place that load_gltf has them: node transforms (ours are
// identity), instances, skins and morph targets as the file stands at rest, without hidden nodes. Only triangles count,
// and vertices that they use. Normals are made where absent. Error for shapes that load_gltf refuses, for a file that
// shows no triangles, and for attributes that are not finite, of the wrong kind, or negative weights.
VertexMesh load_vertex_mesh(const std::filesystem::path& path);

// One node and mesh per part. Where illumination is given it is also written, clamped to 0..1 after dividing by
// `display_white`, as COLOR_0, so that any glTF program shows it.
void save_vertex_mesh(const VertexMesh& mesh, const std::filesystem::path& path, float display_white);

}  // namespace chiaro::renderer

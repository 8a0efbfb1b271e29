#include "renderer/io/vertex_mesh_file.h"

#include <cmath>

#include <fmt/format.h>

#include "renderer/io/gltf_accessors.h"
#include "renderer/io/gltf_document.h"
#include "renderer/io/gltf_nodes.h"
#include "renderer/io/gltf_primitives.h"
#include "renderer/io/mesh_repair.h"

namespace chiaro::renderer {
namespace {

constexpr const char* kIllumination = "_ILLUMINATION";
constexpr const char* kWeight = "_WEIGHT";
constexpr const char* kStandardError = "_STANDARD_ERROR";

std::string attribute_place(const GltfPrimitiveRef& ref, const char* name) {
  return fmt::format("{}.attributes.{}", place_of(ref), name);
}

// Ours are floats: an integer accessor holds something else.
void check_float(const GltfDocument& document, const GltfPrimitiveRef& ref, const char* name) {
  const int accessor = find_attribute(document, ref, name);
  if (accessor >= 0 && !accessor_is_float(document, accessor)) {
    fail(document, attribute_place(ref, name), "is not of floats", "componentType 5126");
  }
}

std::vector<Vec3f> read_illumination(const GltfDocument& document, const GltfPrimitiveRef& ref) {
  check_float(document, ref, kIllumination);
  std::vector<Vec3f> values = read_vec3_attribute(document, ref, kIllumination);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (is_finite(values[i])) continue;
    fail(document, attribute_place(ref, kIllumination), fmt::format("vertex {} is not finite", i), "finite values");
  }
  return values;
}

std::vector<float> read_non_negative(const GltfDocument& document, const GltfPrimitiveRef& ref, const char* name) {
  check_float(document, ref, name);
  std::vector<float> values = read_scalar_attribute(document, ref, name);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i]) && values[i] >= 0) continue;
    fail(document, attribute_place(ref, name), fmt::format("vertex {} is {}", i, values[i]), "finite, not negative");
  }
  return values;
}

std::vector<Vec3f> read_color(const GltfDocument& document, const GltfPrimitiveRef& ref) {
  std::vector<Vec3f> colors;
  for (const Vec4f& c : read_colors(document, ref)) {
    colors.push_back({c.x, c.y, c.z});
    if (is_finite(colors.back())) continue;
    fail(document, attribute_place(ref, "COLOR_0"), fmt::format("vertex {} is not finite", colors.size() - 1),
         "finite values");
  }
  return colors;
}

bool is_identity(const Mat4f& transform) { return transform.m == Mat4f{}.m; }

// Unit normals of files with identity transforms, such as ours, come back bit by bit.
Vec3f world_normal(const Mat4f& transform, Vec3f normal) {
  const bool unit = std::abs(length_squared(normal) - 1) <= 1e-5F;
  return unit && is_identity(transform) ? normal : transform_normal(transform, normal);
}

// In world space; where the file's normal has no direction, or there is none, that of the surface.
std::vector<Vec3f> world_normals(const VertexMeshPart& part, const std::vector<Vec3f>& normals,
                                 const Mat4f& transform) {
  const bool complete = !normals.empty();
  std::vector<Vec3f> world(part.positions.size()), made;
  for (std::size_t i = 0; i < world.size(); ++i) {
    if (complete) world[i] = world_normal(transform, normals[i]);
    if (complete && length_squared(world[i]) > 0) continue;
    if (made.empty()) made = smooth_normals(part.positions, part.triangles);
    world[i] = made[i];
  }
  return world;
}

void move_to_world(const GltfDocument& document, const PlacedNode& node, std::vector<Vec3f>& positions) {
  const bool stays = is_identity(node.world_from_node);
  for (Vec3f& p : positions) {
    if (!stays) p = transform_point(node.world_from_node, p);
    check_in_world(document, node, p, "a vertex");
  }
}

// Mirroring turns triangles inside out.
void flip(std::vector<Triangle>& triangles) {
  for (Triangle& t : triangles) std::swap(t[1], t[2]);
}

VertexMeshPart read_part(const GltfDocument& document, const PlacedNode& node, const GltfPrimitiveRef& ref) {
  VertexMeshPart part;
  part.name = node.name.empty() ? fmt::format("node {}", node.node) : node.name;
  part.positions = read_positions(document, ref);
  move_to_world(document, node, part.positions);
  part.triangles = read_triangles(document, ref).value_or(std::vector<Triangle>{});
  if (determinant3(node.world_from_node) < 0) flip(part.triangles);
  part.normals = world_normals(part, read_vec3_attribute(document, ref, "NORMAL"), node.world_from_node);
  part.illumination = read_illumination(document, ref);
  part.weight = read_non_negative(document, ref, kWeight);
  part.standard_error = read_non_negative(document, ref, kStandardError);
  part.color = read_color(document, ref);
  return part;
}

}  // namespace

VertexMesh load_vertex_mesh(const std::filesystem::path& path) {
  GltfDocument document = open_gltf(path);
  load_buffers(document);
  VertexMesh mesh;
  for (const PlacedNode& node : place_nodes(document)) {
    const int count = node.mesh < 0 ? 0 : int(primitive_count(document, node.mesh));
    for (int p = 0; p < count; ++p) {
      const GltfPrimitiveRef ref{node.mesh, p};
      if (vertex_count(document, ref) > 0) mesh.parts.push_back(read_part(document, node, ref));
    }
  }
  if (mesh.parts.empty()) fail(document, "meshes", "no node shows any vertices", "surfaces to paint on");
  return mesh;
}

}  // namespace chiaro::renderer

#include "renderer/io/vertex_mesh_file.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "renderer/io/gltf_accessors.h"
#include "renderer/io/gltf_document.h"
#include "renderer/io/gltf_nodes.h"
#include "renderer/io/gltf_primitives.h"
#include "renderer/io/gltf_skins.h"
#include "renderer/io/mesh_repair.h"
#include "renderer/io/mesh_vertices.h"
#include "renderer/io/node_meshes.h"

namespace chiaro::renderer {
namespace {

constexpr const char* kIllumination = "_ILLUMINATION";
constexpr const char* kWeight = "_WEIGHT";
constexpr const char* kStandardError = "_STANDARD_ERROR";
constexpr double kMostVertices = 3e7;  // of the instances of a node

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

std::vector<Vec3f> checked_colors(const GltfDocument& document, const GltfPrimitiveRef& ref,
                                  const std::vector<Vec4f>& with_alpha) {
  std::vector<Vec3f> colors;
  for (const Vec4f& c : with_alpha) {
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
std::vector<Vec3f> world_normals(const VertexMeshPart& part, const Mat4f& transform) {
  const bool complete = !part.normals.empty();
  std::vector<Vec3f> world(part.positions.size()), made;
  for (std::size_t i = 0; i < world.size(); ++i) {
    if (complete) world[i] = world_normal(transform, part.normals[i]);
    if (complete && length_squared(world[i]) > 0) continue;
    if (made.empty()) made = smooth_normals(part.positions, part.triangles);
    world[i] = made[i];
  }
  return world;
}

void move_to_world(const GltfDocument& document, const PlacedNode& node, const Mat4f& transform,
                   std::vector<Vec3f>& positions) {
  const bool stays = is_identity(transform);
  for (Vec3f& p : positions) {
    if (!stays) p = transform_point(transform, p);
    check_in_world(document, node, p, "a vertex");
  }
}

// Mirroring turns triangles inside out.
void flip(std::vector<Triangle>& triangles) {
  for (Triangle& t : triangles) std::swap(t[1], t[2]);
}

void drop_unused_vertices(VertexMeshPart& part) {
  const std::vector<std::uint32_t> used = keep_used_vertices(part.triangles, part.positions.size());
  if (used.size() == part.positions.size()) return;
  gather(part.positions, used);
  gather(part.normals, used);
  gather(part.illumination, used);
  gather(part.weight, used);
  gather(part.standard_error, used);
  gather(part.color, used);
}

// In the space of the mesh, its normals as they are.
VertexMeshPart make_part(const GltfDocument& document, const PlacedNode& node, const GltfPrimitiveRef& ref, Mesh mesh) {
  VertexMeshPart part;
  part.name = node.name.empty() ? fmt::format("node {}", node.node) : node.name;
  part.illumination = read_illumination(document, ref);
  part.weight = read_non_negative(document, ref, kWeight);
  part.standard_error = read_non_negative(document, ref, kStandardError);
  part.color = checked_colors(document, ref, mesh.colors);
  part.positions = std::move(mesh.positions);
  part.normals = std::move(mesh.normals);
  part.triangles = std::move(mesh.triangles);
  drop_unused_vertices(part);
  return part;
}

bool shows_area(const VertexMeshPart& part) {
  return std::any_of(part.triangles.begin(), part.triangles.end(),
                     [&](const Triangle& t) { return has_area(part.positions, t); });
}

// Adds nothing where the transform leaves no area.
void add_placed(const GltfDocument& document, const PlacedNode& node, VertexMeshPart part, const Mat4f& transform,
                VertexMesh& mesh) {
  move_to_world(document, node, transform, part.positions);
  const float determinant = determinant3(transform);
  if (!std::isnormal(determinant) && !shows_area(part)) return;
  if (determinant < 0) flip(part.triangles);
  part.normals = world_normals(part, transform);
  mesh.parts.push_back(std::move(part));
}

// What a node shows, as NodeMeshes.
struct NodeParts {
  std::vector<VertexMeshPart> in_node, in_world;
};

NodeParts read_parts(const GltfDocument& document, const PlacedNode& node, const std::vector<Mat4f>& world_from_nodes) {
  NodeParts parts;
  std::optional<std::vector<Mat4f>> skin;
  if (node.skin >= 0) skin = world_from_bind(document, node.skin, world_from_nodes);
  for (int p = 0; p < int(primitive_count(document, node.mesh)); ++p) {
    const GltfPrimitiveRef ref{node.mesh, p};
    std::optional<PosedPrimitive> posed = read_posed_primitive(document, ref, node.weights, skin ? &*skin : nullptr);
    if (!posed || posed->mesh.triangles.empty()) continue;
    (posed->in_world ? parts.in_world : parts.in_node)
        .push_back(make_part(document, node, ref, std::move(posed->mesh)));
  }
  return parts;
}

// A small file may have a mesh of many vertices a great many times.
void require_few_vertices(const GltfDocument& document, const PlacedNode& node, const NodeParts& parts,
                          std::size_t instances) {
  double vertices = 0;
  for (const VertexMeshPart& part : parts.in_node) vertices += double(part.positions.size()) * double(instances);
  if (vertices <= kMostVertices) return;
  fail(document, place_of(node), fmt::format("its {} instances have {:.3g} vertices together", instances, vertices),
       fmt::format("at most {:g}", kMostVertices));
}

// In the order of a scene's instances.
void add_instances(const GltfDocument& document, const PlacedNode& node, NodeParts parts, VertexMesh& mesh) {
  for (VertexMeshPart& part : parts.in_world) add_placed(document, node, std::move(part), Mat4f{}, mesh);
  const std::vector<Mat4f> transforms = instance_transforms(document, node);
  require_few_vertices(document, node, parts, transforms.size());
  for (std::size_t i = 0; i < transforms.size(); ++i) {
    const bool is_last = i + 1 == transforms.size();
    for (VertexMeshPart& part : parts.in_node) {
      add_placed(document, node, is_last ? std::move(part) : part, transforms[i], mesh);
    }
  }
}

}  // namespace

VertexMesh load_vertex_mesh(const std::filesystem::path& path) {
  GltfDocument document = open_gltf(path);
  load_buffers(document);
  VertexMesh mesh;
  mesh.warnings = naming_file(document, document.warnings);
  const std::vector<Mat4f> world = world_from_nodes(document);
  for (const PlacedNode& node : place_nodes(document)) {
    if (node.mesh >= 0) add_instances(document, node, read_parts(document, node, world), mesh);
  }
  if (mesh.parts.empty()) fail(document, "meshes", "no node shows any triangles", "surfaces to paint on");
  return mesh;
}

}  // namespace chiaro::renderer

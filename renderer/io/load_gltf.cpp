#include "renderer/io/load_gltf.h"

#include <map>

#include <fmt/format.h>

#include "renderer/io/gltf_document.h"
#include "renderer/io/gltf_environment.h"
#include "renderer/io/gltf_lights.h"
#include "renderer/io/gltf_materials.h"
#include "renderer/io/gltf_nodes.h"
#include "renderer/io/gltf_primitives.h"
#include "renderer/io/gltf_variants.h"
#include "renderer/io/mesh_repair.h"

namespace chiaro::renderer {
namespace {

Material default_material() {
  Material material;
  material.name = "default";
  return material;
}

// Meshes are read when a node first asks for them, and shared from then on.
class MeshReader {
 public:
  MeshReader(const GltfDocument& document, Scene& scene, int variant)
      : document_(document), scene_(scene), variant_(variant) {}

  // The scene's meshes for the primitives of a glTF mesh.
  const std::vector<int>& meshes_of(int gltf_mesh) {
    const auto [found, is_new] = meshes_.try_emplace(gltf_mesh);
    if (is_new) {
      const int count = int(primitive_count(document_, gltf_mesh));
      for (int p = 0; p < count; ++p) add_primitive({gltf_mesh, p}, found->second);
    }
    return found->second;
  }

  std::size_t primitives_without_triangles() const { return without_triangles_; }
  const MeshRepairs& repairs() const { return repairs_; }

 private:
  void add_primitive(const GltfPrimitiveRef& ref, std::vector<int>& meshes) {
    std::optional<Mesh> mesh = read_primitive(document_, ref);
    if (!mesh) {
      ++without_triangles_;
      return;
    }
    repair_mesh(*mesh, repairs_);
    if (mesh->triangles.empty()) return;
    mesh->material = material_in_variant(document_, ref, variant_, mesh->material);
    if (mesh->material < 0) mesh->material = default_material_index();
    meshes.push_back(int(scene_.meshes.size()));
    scene_.meshes.push_back(*std::move(mesh));
  }

  int default_material_index() {
    if (default_material_ < 0) {
      default_material_ = int(scene_.materials.size());
      scene_.materials.push_back(default_material());
    }
    return default_material_;
  }

  const GltfDocument& document_;
  Scene& scene_;
  int variant_;
  std::map<int, std::vector<int>> meshes_;
  MeshRepairs repairs_;
  std::size_t without_triangles_ = 0;
  int default_material_ = -1;
};

std::string instance_name(const PlacedNode& node, const Mesh& mesh) {
  if (!node.name.empty()) return node.name;
  return mesh.name.empty() ? fmt::format("node {}", node.node) : mesh.name;
}

void check_finite(const GltfDocument& document, const PlacedNode& node, const Mesh& mesh, const Mat4f& transform) {
  for (const Vec3f& p : mesh.positions) {
    if (!is_finite(transform_point(transform, p))) fail(document, place_of(node), "puts vertices at infinity");
  }
}

// Copies without volume, as scales of zero make them, cannot be seen. Returns how many were left out.
std::size_t add_instances(const GltfDocument& document, const PlacedNode& node, MeshReader& reader, Scene& scene) {
  std::size_t flattened = 0;
  const std::vector<int> meshes = reader.meshes_of(node.mesh);
  for (const Mat4f& transform : instance_transforms(document, node)) {
    const float determinant = determinant3(transform);
    if (determinant == 0 || !std::isfinite(determinant)) {
      ++flattened;
      continue;
    }
    for (const int mesh : meshes) {
      check_finite(document, node, scene.meshes[mesh], transform);
      scene.instances.push_back({instance_name(node, scene.meshes[mesh]), mesh, transform});
    }
  }
  return flattened;
}

void warn(std::vector<std::string>& warnings, std::size_t count, const char* what) {
  if (count > 0) warnings.push_back(fmt::format("{} {}", count, what));
}

void warn_of_repairs(const MeshReader& reader, std::size_t flattened, std::vector<std::string>& warnings) {
  const MeshRepairs& repairs = reader.repairs();
  warn(warnings, repairs.degenerate_triangles, "triangles of zero area are left out");
  warn(warnings, repairs.bad_normals, "normals of no direction are replaced by the surface's");
  warn(warnings, repairs.bad_tangent_meshes, "meshes have tangents of no direction; they are made anew");
  warn(warnings, repairs.bad_coordinates, "texture coordinates or colours that are not finite are replaced");
  warn(warnings, reader.primitives_without_triangles(), "primitives without triangles (points, lines) are left out");
  warn(warnings, flattened, "instances scaled to nothing are left out");
}

void warn_of_motion(const GltfJson& json, std::vector<std::string>& warnings) {
  if (json.has_animations) warnings.push_back("animations are not played: the scene is as its nodes stand");
  if (json.has_skins) warnings.push_back("skins are not applied: skinned meshes are as they were modelled");
  if (json.has_morph_targets) warnings.push_back("morph targets are not applied");
}

}  // namespace

LoadedScene load_gltf(const std::filesystem::path& path, const LoadOptions& options) {
  GltfDocument document = open_gltf(path);
  const int variant = find_variant(document, options.variant);
  load_buffers(document);
  LoadedScene loaded;
  loaded.warnings = document.warnings;
  loaded.variants = variant_names(document);
  warn_of_motion(document.json, loaded.warnings);
  Scene& scene = loaded.scene;
  scene.path = path.string();

  GltfMaterials materials = read_materials(document, loaded.warnings);
  scene.materials = std::move(materials.materials);
  scene.textures = std::move(materials.textures);

  const std::vector<PlacedNode> nodes = place_nodes(document);
  MeshReader reader(document, scene, variant);
  std::size_t flattened = 0;
  for (const PlacedNode& node : nodes) {
    if (node.mesh >= 0) flattened += add_instances(document, node, reader, scene);
  }
  warn_of_repairs(reader, flattened, loaded.warnings);
  if (scene.materials.empty()) scene.materials.push_back(default_material());

  scene.cameras = read_cameras(document, nodes);
  loaded.lights = read_lights(document, nodes, loaded.warnings);
  if (auto environment = read_environment(document, loaded.warnings)) loaded.lights.push_back(*std::move(environment));
  return loaded;
}

}  // namespace chiaro::renderer

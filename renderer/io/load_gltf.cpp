#include "renderer/io/load_gltf.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "renderer/core/counted.h"
#include "renderer/core/world_limits.h"
#include "renderer/io/gltf_document.h"
#include "renderer/io/gltf_environment.h"
#include "renderer/io/gltf_lights.h"
#include "renderer/io/gltf_materials.h"
#include "renderer/io/gltf_nodes.h"
#include "renderer/io/gltf_variants.h"
#include "renderer/io/mesh_repair.h"
#include "renderer/io/missing_coordinates.h"
#include "renderer/io/node_meshes.h"

namespace chiaro::renderer {
namespace {

// Between neighbours among floats, of the scene's size: …
constexpr float kCoarse = 1e-4F;     // … light is off by a tenth of a percent or more …
constexpr float kTooCoarse = 5e-3F;  // … or by more than some

std::string node_name(const PlacedNode& node) {
  return node.name.empty() ? fmt::format("node {}", node.node) : node.name;
}

std::string instance_name(const PlacedNode& node, const Mesh& mesh) {
  return node.name.empty() && !mesh.name.empty() ? mesh.name : node_name(node);
}

// At their index in the file.
std::vector<SceneNode> hierarchy_of(const std::vector<PlacedNode>& placed) {
  std::vector<SceneNode> nodes;
  for (const PlacedNode& node : placed) {
    nodes.resize(std::max(nodes.size(), std::size_t(std::max(node.node, node.parent) + 1)));
    nodes[std::size_t(node.node)] = {node_name(node), node.parent};
  }
  return nodes;
}

// Everything comes to one place.
bool is_point(const Mat4f& transform) {
  return std::all_of(transform.m.begin(), transform.m.begin() + 12, [](float entry) { return entry == 0; });
}

// Nodes may share the positions of their instances, so that a small file could ask for any number.
std::size_t most_instances(const GltfDocument& document) {
  std::size_t most = (std::size_t{1} << 20) + document.json.size;
  for (const std::string& buffer : document.buffers) most += buffer.size();
  return most;
}

class InstanceList {
 public:
  InstanceList(const GltfDocument& document, Scene& scene)
      : document_(document), scene_(scene), most_(most_instances(document)) {}

  void add(const PlacedNode& node, const NodeMeshes& meshes) {
    for (const int mesh : meshes.in_world) add_instance(node, mesh, Mat4f{});
    const std::vector<Mat4f> transforms = instance_transforms(document_, node);
    check_count(node, scene_.instances.size() + transforms.size() * meshes.in_node.size());
    for (const Mat4f& transform : transforms) {
      const bool invertible = std::isnormal(determinant3(transform));
      const std::size_t before = scene_.instances.size();
      for (const int mesh : meshes.in_node) {
        if (invertible) {
          add_instance(node, mesh, transform);
        } else {
          add_as_mesh_of_its_own(node, mesh, transform);
        }
      }
      left_out_ += !meshes.in_node.empty() && scene_.instances.size() == before ? 1 : 0;
    }
  }

  // Copies that are scaled to nothing.
  std::size_t left_out() const { return left_out_; }

 private:
  void check_count(const PlacedNode& node, std::size_t count) const {
    if (count <= most_) return;
    fail(document_, place_of(node), fmt::format("makes {} instances of what is in the file", count),
         fmt::format("at most {}, as many as there is data and a million", most_));
  }

  void check_vertices(const PlacedNode& node, int index, const Mat4f& transform) {
    const Mesh& mesh = scene_.meshes[std::size_t(index)];
    if (mesh_bounds_.size() < scene_.meshes.size()) mesh_bounds_.resize(scene_.meshes.size());
    std::optional<Box3f>& bounds = mesh_bounds_[std::size_t(index)];
    if (!bounds) {
      bounds.emplace();
      for (const Vec3f& p : mesh.positions) bounds->extend(is_finite(p) ? p : Vec3f{kInfinity, kInfinity, kInfinity});
    }
    const Box3f moved = transform_box(transform, *bounds);
    if (in_world(moved.min) && in_world(moved.max)) return;
    for (const Vec3f& p : mesh.positions) check_in_world(document_, node, transform_point(transform, p), "a vertex");
  }

  void add_instance(const PlacedNode& node, int index, const Mat4f& transform) {
    check_vertices(node, index, transform);
    scene_.instances.push_back({instance_name(node, scene_.meshes[std::size_t(index)]), index, transform, node.node});
  }

  // Of transforms that have no inverse, as scales of zero, or none in floats. Adds nothing where no area is left.
  void add_as_mesh_of_its_own(const PlacedNode& node, int index, const Mat4f& transform) {
    if (is_point(transform)) return;
    check_vertices(node, index, transform);
    std::optional<Mesh> mesh = mesh_in_world(scene_, index, transform);
    if (!mesh) return;
    scene_.meshes.push_back(*std::move(mesh));
    add_instance(node, int(scene_.meshes.size()) - 1, Mat4f{});
  }

  const GltfDocument& document_;
  Scene& scene_;
  std::size_t most_, left_out_ = 0;
  std::vector<std::optional<Box3f>> mesh_bounds_;
};

void check_size(const GltfDocument& document, const Box3f& bounds) {
  const float across = bounds.diagonal();
  if (across >= kLeastScene) return;
  fail(document, "scene", fmt::format("all surfaces together are {:g} m across", across),
       fmt::format("{:g} m or more: glTF's unit is the metre", kLeastScene));
}

// Floats are the farther apart the farther from the origin they are.
void check_spacing(const GltfDocument& document, const Box3f& bounds, std::vector<std::string>& warnings) {
  const float farthest = max_component(max(abs(bounds.min), abs(bounds.max))), across = bounds.diagonal();
  const float spacing = spacing_at(farthest);
  if (spacing <= kCoarse * across) return;
  const std::string where =
      fmt::format("surfaces {:.3g} m across lie {:.3g} m from the origin, where positions are {:.2g} m apart", across,
                  farthest, spacing);
  if (spacing > kTooCoarse * across) fail(document, "scene", where, "a scene nearer to the origin");
  warnings.push_back(where + ": light may be off by some percent; move the scene nearer to it");
}

void warn(std::vector<std::string>& warnings, std::size_t count, const char* one, const char* many) {
  if (count > 0) warnings.push_back(counted(count, one, many));
}

void warn_of_repairs(const NodeMeshList& meshes, std::size_t left_out, std::vector<std::string>& warnings) {
  const MeshRepairs& repairs = meshes.repairs;
  warn(warnings, repairs.degenerate_triangles, "triangle of zero area is left out",
       "triangles of zero area are left out");
  warn(warnings, repairs.bad_normals, "normal of no direction is replaced by the surface's",
       "normals of no direction are replaced by the surface's");
  warn(warnings, repairs.bad_tangent_meshes, "mesh has tangents of no direction; they are made anew",
       "meshes have tangents of no direction; they are made anew");
  warn(warnings, repairs.bad_coordinates, "texture coordinate or colour that is not finite is replaced",
       "texture coordinates or colours that are not finite are replaced");
  warn(warnings, repairs.bad_skin_weights, "vertex has skin weights that do not add up to 1; they are mended",
       "vertices have skin weights that do not add up to 1; they are mended");
  warn(warnings, repairs.spare_corners, "corner at the end of a list makes no triangle and is left out",
       "corners at the ends of lists make no triangle and are left out");
  warn(warnings, meshes.without_triangles, "primitive without triangles (points, lines) is left out",
       "primitives without triangles (points, lines) are left out");
  warn(warnings, left_out, "instance scaled to nothing is left out", "instances scaled to nothing are left out");
}

}  // namespace

LoadedScene load_gltf(const std::filesystem::path& path, const LoadOptions& options, const Control& control) {
  GltfDocument document = open_gltf(path, options.external);
  const int variant = find_variant(document, options.variant);
  load_buffers(document);
  LoadedScene loaded;
  loaded.warnings = document.warnings;
  loaded.variants = variant_names(document);
  Scene& scene = loaded.scene;
  scene.path = path.string();

  GltfMaterials materials = read_materials(document, loaded.warnings, control);
  scene.materials = std::move(materials.materials);
  scene.textures = std::move(materials.textures);

  const GltfPose pose = pose_at(document, options.animation, loaded.warnings);
  const std::vector<PlacedNode> nodes = place_nodes(document, pose);
  scene.nodes = hierarchy_of(nodes);
  const NodeMeshList meshes = read_node_meshes(document, nodes, {world_from_nodes(document, pose), variant}, scene);
  InstanceList instances(document, scene);
  for (std::size_t n = 0; n < nodes.size(); ++n) instances.add(nodes[n], meshes.of_node[n]);
  if (!scene.instances.empty()) {
    const Box3f box = bounds(scene);
    check_size(document, box);
    check_spacing(document, box, loaded.warnings);
  }
  warn_of_repairs(meshes, instances.left_out(), loaded.warnings);
  const std::vector<std::string> missing = warnings_of_missing_coordinates(scene);
  loaded.warnings.insert(loaded.warnings.end(), missing.begin(), missing.end());
  if (scene.materials.empty()) scene.materials.push_back(default_material());

  scene.cameras = read_cameras(document, nodes);
  NodeLights punctual = read_lights(document, nodes, loaded.warnings);
  loaded.lights = std::move(punctual.lights);
  loaded.light_nodes = std::move(punctual.nodes);
  if (auto environment = read_environment(document, loaded.warnings)) loaded.lights.push_back(*std::move(environment));
  loaded.warnings = naming_file(document, std::move(loaded.warnings));
  return loaded;
}

}  // namespace chiaro::renderer

#pragma once
// A scene as the renderer sees it: meshes, instances, materials, textures, cameras. Immutable after loading.
// World space: right-handed, +Y up, metres. Colours: scene-linear Rec.709. Lights are not part of it.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "renderer/core/vec.h"
#include "renderer/image/texture.h"
#include "renderer/scene/material_layers.h"
#include "renderer/scene/texture_use.h"

namespace chiaro::renderer {

enum class AlphaMode : std::uint8_t { kOpaque, kMask, kBlend };

// glTF 2.0 metallic-roughness. Factors are multiplied with their textures, as the specification says.
struct Material {
  std::string name;
  Vec3f base_color{1, 1, 1};
  float alpha = 1;
  TextureUse base_color_texture;  // sRGB
  float metallic = 1, roughness = 1;
  TextureUse metallic_roughness_texture;  // G roughness, B metallic; linear
  TextureUse normal_texture;              // linear
  float normal_scale = 1;
  Vec3f emission{0, 0, 0};      // cd/m²: emissiveFactor times KHR_materials_emissive_strength
  TextureUse emission_texture;  // sRGB
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5F;
  bool double_sided = false;             // light and cameras see both sides of every surface, unless hidden_back
  bool hidden_back = false;              // cameras see through it from the back
  bool lambert = false;                  // Lambert of the base colour instead of metallic-roughness
  bool geometric_horizon = false;        // no light from below a triangle's horizon, whatever the vertex normals see
  bool constant_base_color = false;      // neither texture nor vertex colour changes the base colour; alpha still does
  bool unlit = false;                    // KHR_materials_unlit: seen as its base colour, and no part of light transport
  std::optional<MaterialLayers> layers;  // absent: plain metallic-roughness
};

using Triangle = std::array<std::uint32_t, 3>;

// One glTF primitive. normals have the length of positions (made flat on loading where absent); tangents, uv sets and
// colors are empty or have that length too.
struct Mesh {
  std::string name;
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;
  std::vector<Vec4f> tangents;  // w: handedness
  std::array<std::vector<Vec2f>, kUvSetCount> uv;
  std::vector<Vec4f> colors;  // linear RGBA
  std::vector<Triangle> triangles;
  int material = 0;  // index into Scene::materials
};

// A mesh placed in the world.
struct Instance {
  std::string name;  // of the glTF node
  int mesh = 0;      // index into Scene::meshes
  Mat4f world_from_object;
  int node = -1;  // index into Scene::nodes; -1: none
};

// One of those that instances hang on, directly or not.
struct SceneNode {
  std::string name;
  int parent = -1;  // index into Scene::nodes; -1: none
};

// Looks along its -Z axis, +Y up.
struct Camera {
  std::string name;
  Mat4f world_from_camera;
  bool orthographic = false;
  float vertical_fov = 0.7F;              // radians; perspective
  float half_width = 1, half_height = 1;  // metres; orthographic (glTF xmag, ymag)
  float aspect_ratio = 0;                 // width / height; 0: not given
  float near = 0.01F, far = kInfinity;    // metres
};

struct Scene {
  std::string path;  // where it was loaded from, for messages
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<SceneNode> nodes;
  std::vector<Material> materials;  // never empty
  std::vector<Texture> textures;
  std::vector<Camera> cameras;
};

// Whether it is called so, or a node is that it hangs on.
bool belongs_to(const Scene& scene, const Instance& instance, const std::string& name);

// World, over all instances' triangles; empty where there are none.
Box3f bounds(const Scene& scene);
// The same over those of instances that belong to a node.
Box3f bounds_of_node(const Scene& scene, const std::string& name);

// Fingerprint of all that light transport depends on: geometry, instances, materials, textures; not cameras.
std::string fingerprint(const Scene& scene);

// Whether any material that an instance shows is such.
template <class Predicate>
bool any_drawn_material(const Scene& scene, const Predicate& is) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    return is(scene.materials[std::size_t(scene.meshes[std::size_t(instance.mesh)].material)]);
  });
}

bool has_emission(const Scene& scene);                 // unlit surfaces have none
std::size_t drawn_triangle_count(const Scene& scene);  // instances counted each
std::vector<int> instances_per_mesh(const Scene& scene);

}  // namespace chiaro::renderer

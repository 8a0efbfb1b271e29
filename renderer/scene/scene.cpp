#include "renderer/scene/scene.h"

#include <span>

#include "renderer/core/fingerprint.h"

namespace chiaro::renderer {
namespace {

void add(Fingerprint& f, const TextureUse& use) {
  f.add(use.texture);
  f.add(use.uv_set);
  if (use.transformed) f.add(use.transform.m);
}

void add(Fingerprint& f, const MaterialLayers& l) {
  for (const float value : {l.ior, l.specular, l.transmission, l.clearcoat, l.clearcoat_roughness,
                            l.clearcoat_normal_scale, l.sheen_roughness}) {
    f.add(value);
  }
  for (const Vec3f color : {l.specular_color, l.absorption, l.sheen_color}) f.add(color);
  f.add(l.solid);
  for (const TextureUse* use : {&l.specular_texture, &l.specular_color_texture, &l.transmission_texture,
                                &l.clearcoat_texture, &l.clearcoat_roughness_texture, &l.clearcoat_normal_texture,
                                &l.sheen_color_texture, &l.sheen_roughness_texture}) {
    add(f, *use);
  }
}

void add(Fingerprint& f, const Material& m) {
  f.add(m.base_color);
  f.add(m.alpha);
  f.add(m.metallic);
  f.add(m.roughness);
  f.add(m.normal_scale);
  f.add(m.emission);
  f.add(m.alpha_mode);
  f.add(m.alpha_cutoff);
  f.add(m.lambert);
  f.add(m.constant_base_color);
  if (m.unlit) f.add(m.unlit);
  if (m.layers) add(f, *m.layers);
  for (const TextureUse* use :
       {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture, &m.emission_texture}) {
    add(f, *use);
  }
}

template <class T>
void add(Fingerprint& f, const std::vector<T>& values) {
  f.add_all(std::span<const T>(values));
}

void add(Fingerprint& f, const Texture& texture) {
  f.add(texture.width);
  f.add(texture.height);
  f.add(texture.nearest);
  f.add(texture.wrap_u);
  f.add(texture.wrap_v);
  f.add(texture.filtered_as_stored);
  add(f, texture.rgba);
  if (is_wide(texture)) add(f, texture.wide_rgba);
}

// Around the triangles of instances.
class InstanceBounds {
 public:
  explicit InstanceBounds(const Scene& scene) : scene_(scene), of_mesh_(scene.meshes.size()) {}

  void extend_around(const Instance& instance) {
    const Mesh& mesh = scene_.meshes[instance.mesh];
    std::optional<Box3f>& of_mesh = of_mesh_[instance.mesh];
    if (!of_mesh) of_mesh = around(mesh, Mat4f{});
    if (box_.encloses(transform_box(instance.world_from_object, *of_mesh))) return;
    const Box3f box = around(mesh, instance.world_from_object);
    box_.extend(box.min);
    box_.extend(box.max);
  }

  Box3f box() const { return box_; }

 private:
  static Box3f around(const Mesh& mesh, const Mat4f& transform) {
    Box3f box;
    for (const Triangle& triangle : mesh.triangles) {
      for (const std::uint32_t v : triangle) box.extend(transform_point(transform, mesh.positions[v]));
    }
    return box;
  }

  const Scene& scene_;
  std::vector<std::optional<Box3f>> of_mesh_;
  Box3f box_;
};

}  // namespace

bool belongs_to(const Scene& scene, const Instance& instance, const std::string& name) {
  if (instance.name == name) return true;
  for (int node = instance.node; node >= 0; node = scene.nodes[std::size_t(node)].parent) {
    if (scene.nodes[std::size_t(node)].name == name) return true;
  }
  return false;
}

Box3f bounds(const Scene& scene) {
  InstanceBounds bounds(scene);
  for (const Instance& instance : scene.instances) bounds.extend_around(instance);
  return bounds.box();
}

Box3f bounds_of_node(const Scene& scene, const std::string& name) {
  InstanceBounds bounds(scene);
  for (const Instance& instance : scene.instances) {
    if (belongs_to(scene, instance, name)) bounds.extend_around(instance);
  }
  return bounds.box();
}

std::string fingerprint(const Scene& scene) {
  Fingerprint f;
  for (const Mesh& mesh : scene.meshes) {
    add(f, mesh.positions);
    add(f, mesh.normals);
    add(f, mesh.triangles);
    for (std::size_t n = 0; n < mesh.uv.size(); ++n) {
      if (n < 2 || !mesh.uv[n].empty()) add(f, mesh.uv[n]);
    }
    if (!mesh.tangents.empty()) add(f, mesh.tangents);
    add(f, mesh.colors);
    f.add(mesh.material);
  }
  for (const Instance& instance : scene.instances) {
    f.add(instance.mesh);
    f.add(instance.world_from_object);
  }
  for (const Material& material : scene.materials) add(f, material);
  for (const Texture& texture : scene.textures) add(f, texture);
  return f.text();
}

std::vector<int> instances_per_mesh(const Scene& scene) {
  std::vector<int> count(scene.meshes.size(), 0);
  for (const Instance& instance : scene.instances) ++count[instance.mesh];
  return count;
}

bool has_emission(const Scene& scene) {
  return any_drawn_material(scene, [](const Material& material) { return max_component(material.emission) > 0; });
}

std::size_t drawn_triangle_count(const Scene& scene) {
  std::size_t count = 0;
  for (const Instance& instance : scene.instances) count += scene.meshes[instance.mesh].triangles.size();
  return count;
}

}  // namespace chiaro::renderer

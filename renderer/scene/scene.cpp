#include "renderer/scene/scene.h"

#include <span>

#include "renderer/core/fingerprint.h"

namespace chiaro::renderer {
namespace {

void add(Fingerprint& f, const TextureUse& use) {
  f.add(use.texture);
  f.add(use.uv_set);
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
  for (const TextureUse* use :
       {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture, &m.emission_texture}) {
    add(f, *use);
  }
}

template <class T>
void add(Fingerprint& f, const std::vector<T>& values) {
  f.add_all(std::span<const T>(values));
}

}  // namespace

Box3f bounds(const Scene& scene) {
  Box3f box;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (const Triangle& triangle : mesh.triangles) {
      for (const std::uint32_t v : triangle) box.extend(transform_point(instance.world_from_object, mesh.positions[v]));
    }
  }
  return box;
}

std::string fingerprint(const Scene& scene) {
  Fingerprint f;
  for (const Mesh& mesh : scene.meshes) {
    add(f, mesh.positions);
    add(f, mesh.normals);
    add(f, mesh.triangles);
    add(f, mesh.uv[0]);
    add(f, mesh.uv[1]);
    add(f, mesh.colors);
    f.add(mesh.material);
  }
  for (const Instance& instance : scene.instances) {
    f.add(instance.mesh);
    f.add(instance.world_from_object);
  }
  for (const Material& material : scene.materials) add(f, material);
  for (const Texture& texture : scene.textures) add(f, texture.rgba);
  return f.text();
}

std::size_t drawn_triangle_count(const Scene& scene) {
  std::size_t count = 0;
  for (const Instance& instance : scene.instances) count += scene.meshes[instance.mesh].triangles.size();
  return count;
}

}  // namespace chiaro::renderer

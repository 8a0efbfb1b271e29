#include "tests/support/code_scenes.h"

namespace chiaro::test {

using renderer::Mesh;
using renderer::Scene;

renderer::Material lambert(Vec3f albedo, Vec3f emission) {
  renderer::Material material;
  material.base_color = albedo;
  material.emission = emission;
  material.metallic = 0;
  material.lambert = true;
  return material;
}

void add_mesh(Scene& scene, Mesh mesh, const renderer::Material& material, const std::string& name) {
  mesh.name = name;
  mesh.material = int(scene.materials.size());
  scene.materials.push_back(material);
  scene.instances.push_back({name, int(scene.meshes.size()), {}});
  scene.meshes.push_back(std::move(mesh));
}

Mesh rectangle(Vec3f corner, Vec3f u, Vec3f v, int n) {
  Mesh mesh;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) mesh.positions.push_back(corner + (float(i) / n) * u + (float(j) / n) * v);
  }
  mesh.normals.assign(mesh.positions.size(), normalize(cross(u, v)));
  for (std::uint32_t j = 0; j < std::uint32_t(n); ++j) {
    for (std::uint32_t i = 0; i < std::uint32_t(n); ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {a, d, c}});
    }
  }
  return mesh;
}

Mesh room(Vec3f s, int n) {
  const Vec3f x{s.x, 0, 0}, y{0, s.y, 0}, z{0, 0, s.z}, o{0, 0, 0};
  Mesh whole;
  for (const Mesh& side : {rectangle(o, z, x, n), rectangle(y, x, z, n), rectangle(o, x, y, n), rectangle(z, y, x, n),
                           rectangle(o, y, z, n), rectangle(x, z, y, n)}) {
    const auto base = std::uint32_t(whole.positions.size());
    whole.positions.insert(whole.positions.end(), side.positions.begin(), side.positions.end());
    whole.normals.insert(whole.normals.end(), side.normals.begin(), side.normals.end());
    for (const auto& t : side.triangles) whole.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
  return whole;
}

Mesh sphere(Vec3f center, float radius, int bands, bool inwards) {
  Mesh mesh;
  const int segments = 2 * bands;
  const float side = inwards ? -1.0F : 1.0F;
  for (int j = 0; j <= bands; ++j) {
    for (int i = 0; i < segments; ++i) {
      const float theta = renderer::kPi * float(j) / float(bands), phi = 2 * renderer::kPi * float(i) / float(segments);
      const Vec3f n{std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
      mesh.positions.push_back(center + radius * n);
      mesh.normals.push_back(side * n);
    }
  }
  const auto at = [&](int j, int i) { return std::uint32_t(j * segments + i % segments); };
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.triangles.push_back(inwards ? renderer::Triangle{a, b, c} : renderer::Triangle{a, c, b});
  };
  for (int j = 0; j < bands; ++j) {
    for (int i = 0; i < segments; ++i) {
      if (j > 0) add(at(j, i), at(j + 1, i), at(j, i + 1));
      if (j + 1 < bands || j == 0) add(at(j, i + 1), at(j + 1, i), at(j + 1, i + 1));
    }
  }
  std::erase_if(mesh.triangles, [&](const renderer::Triangle& t) {
    const auto& p = mesh.positions;
    return length(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]])) < 1e-9F * radius * radius;
  });
  return mesh;
}

Scene plane_scene(Vec3f albedo) {
  Scene scene;
  add_mesh(scene, rectangle({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, 10), lambert(albedo), "plane");
  return scene;
}

Scene corner_with_ball() {
  Scene scene;
  scene.path = "corner_with_ball";
  add_mesh(scene, rectangle({0, 0, 0}, {0, 0, 4}, {4, 0, 0}, 20), lambert({0.7F, 0.7F, 0.7F}), "floor");
  add_mesh(scene, rectangle({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, 16), lambert({0.7F, 0.3F, 0.2F}), "back");
  add_mesh(scene, rectangle({0, 0, 0}, {0, 3, 0}, {0, 0, 4}, 16), lambert({0.2F, 0.4F, 0.7F}), "left");
  add_mesh(scene, sphere({2.2F, 0.6F, 1.8F}, 0.6F, 12), lambert({0.8F, 0.8F, 0.8F}), "ball");
  return scene;
}

}  // namespace chiaro::test

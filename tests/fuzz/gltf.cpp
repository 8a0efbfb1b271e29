// Scenes: whatever is loaded, the renderer can walk through without looking.

#include <cmath>

#include "renderer/io/load_gltf.h"
#include "tests/fuzz/gltf_input.h"

namespace chiaro::fuzz {
namespace {

using renderer::Mesh;
using renderer::Scene;
using renderer::Vec3f;

void check(const Mesh& mesh, const Scene& scene) {
  const std::size_t count = mesh.positions.size();
  CHIARO_CHECK(mesh.normals.size() == count);
  CHIARO_CHECK(mesh.tangents.empty() || mesh.tangents.size() == count);
  CHIARO_CHECK(mesh.colors.empty() || mesh.colors.size() == count);
  for (const auto& set : mesh.uv) CHIARO_CHECK(set.empty() || set.size() == count);
  for (const Vec3f& position : mesh.positions) CHIARO_CHECK(is_finite(position));
  for (const Vec3f& normal : mesh.normals) CHIARO_CHECK(is_finite(normal));
  for (const renderer::Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) CHIARO_CHECK(vertex < count);
  }
  CHIARO_CHECK(std::size_t(mesh.material) < scene.materials.size());
}

void check(const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) check(mesh, scene);
  for (const renderer::Instance& instance : scene.instances) {
    CHIARO_CHECK(std::size_t(instance.mesh) < scene.meshes.size());
  }
}

}  // namespace
}  // namespace chiaro::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace chiaro;
  const std::filesystem::path path = fuzz::gltf_file(data, size);
  fuzz::read_or_refuse(path, [&] { fuzz::check(renderer::load_gltf(path).scene); });
  const renderer::LoadOptions halfway{.animation = {"", 0.5}, .variant = {}};
  fuzz::read_or_refuse(path, [&] { fuzz::check(renderer::load_gltf(path, halfway).scene); });
  return 0;
}

// Strokes, and what they paint on a corner of three walls.

#include <cmath>

#include "inverse/target/paint.h"
#include "tests/fuzz/input_file.h"

namespace chiaro::fuzz {
namespace {

inverse::Target black_corner() {
  renderer::Scene scene;
  scene.materials.resize(1);
  renderer::Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.normals.assign(4, normalize(renderer::Vec3f{1, 1, 1}));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}};
  scene.meshes.push_back(mesh);
  scene.instances.resize(1);
  inverse::Target target;
  target.receivers = inverse::make_receivers(scene, {.max_edge = 0.5F});
  target.illumination.resize(target.receivers.size());
  target.weight.resize(target.receivers.size(), 1);
  return target;
}

void paint_all(const inverse::Strokes& strokes) {
  static const inverse::Target base = black_corner();
  const inverse::Target painted = inverse::paint(base, strokes, {}).target;
  for (const renderer::Vec3f& value : painted.illumination) {
    CHIARO_CHECK(is_finite(value));
  }
  for (const float weight : painted.weight) CHIARO_CHECK(weight >= 0 && std::isfinite(weight));
}

}  // namespace
}  // namespace chiaro::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace chiaro;
  const std::filesystem::path path = fuzz::input_file("strokes.json", fuzz::text_of(data, size));
  inverse::Strokes strokes;
  if (fuzz::read_or_refuse(path, [&] { strokes = inverse::load_strokes(path); })) fuzz::paint_all(strokes);
  return 0;
}

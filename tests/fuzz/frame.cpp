// Scenes, rendered: whatever a file says, pixels are numbers.

#include <cmath>

#include "renderer/io/load_gltf.h"
#include "renderer/trace/render.h"
#include "tests/fuzz/gltf_input.h"

namespace chiaro::fuzz {
namespace {

void render(const renderer::LoadedScene& loaded) {
  const renderer::Scene& scene = loaded.scene;
  if (renderer::drawn_triangle_count(scene) == 0 || renderer::drawn_triangle_count(scene) > 1000) return;
  const renderer::RayTracer tracer(scene);
  const renderer::Camera camera = scene.cameras.empty() ? renderer::default_camera(scene) : scene.cameras.front();
  renderer::Lights lights = loaded.lights;
  if (lights.empty()) lights.push_back(renderer::PointLight{.position = {0, 0, 1}, .intensity = {1, 1, 1}});
  renderer::RenderOptions options{.width = 3, .height = 2};
  options.trace = {.samples = 1, .bounces = 4};
  const renderer::Frame frame = renderer::render(tracer, camera, lights, options);
  for (const float value : frame.image.pixels) CHIARO_CHECK(std::isfinite(value));
}

}  // namespace
}  // namespace chiaro::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace chiaro;
  const std::filesystem::path path = fuzz::gltf_file(data, size);
  fuzz::read_or_refuse(path, [&] { fuzz::render(renderer::load_gltf(path)); });
  return 0;
}

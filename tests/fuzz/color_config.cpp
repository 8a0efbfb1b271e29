// OpenColorIO configs.

#include "renderer/image/color_management.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace chiaro;
  const std::filesystem::path path = fuzz::input_file("config.ocio", fuzz::text_of(data, size));
  renderer::Image grey = renderer::make_image(1, 1, {"R", "G", "B"});
  grey.pixels = {0.18F, 0.18F, 0.18F};
  fuzz::read_or_refuse(path, [&] { renderer::apply_display_view(grey, path, {}); });
  fuzz::read_or_refuse(path, [&] { renderer::to_rec709_from_display_view(grey, path, {}); });
  fuzz::read_or_refuse(path, [&] { renderer::convert_to_rec709(grey, path, "scene_linear"); });
  return 0;
}

// Pictures: the first byte of an input says under which extension the rest is a file.

#include <array>

#include "renderer/image/image_file.h"
#include "renderer/image/scene_linear.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace chiaro;
  constexpr std::array kNames{"image.exr",  "image.png", "image.hdr", "image.jpg", "image.tif",
                              "image.webp", "image.tga", "image.pfm", "image.ppm"};
  if (size == 0) return 0;
  const std::string_view bytes = fuzz::text_of(data + 1, size - 1);
  const std::filesystem::path path = fuzz::input_file(kNames[data[0] % kNames.size()], bytes);
  fuzz::read_or_refuse(path, [&] { renderer::load_image_header(path); });
  fuzz::read_or_refuse(path, [&] {
    const renderer::ImageFile file = renderer::load_image(path);
    CHIARO_CHECK(file.image.width > 0 && file.image.height > 0);
    renderer::scene_linear_rec709(file, path.string());
  });
  return 0;
}

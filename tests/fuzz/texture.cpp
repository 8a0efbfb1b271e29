// Textures in memory, as glTF files hold them.

#include "renderer/image/image_file.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace chiaro;
  fuzz::read_or_refuse("images[0]", [&] {
    const renderer::Texture texture = renderer::decode_texture(fuzz::text_of(data, size), "images[0]");
    CHIARO_CHECK(texture.width > 0 && texture.height > 0);
  });
  return 0;
}

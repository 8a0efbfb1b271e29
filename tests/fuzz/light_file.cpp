// Light files in JSON.

#include "renderer/io/light_file.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace chiaro;
  const std::filesystem::path path = fuzz::input_file("lights.json", fuzz::text_of(data, size));
  fuzz::read_or_refuse(path, [&] { CHIARO_CHECK(!renderer::load_lights(path).empty()); });
  return 0;
}

// Caches, whole and unfinished.

#include "inverse/transport/transport_cache.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace chiaro;
  const std::filesystem::path path = fuzz::input_file("cache.exr", fuzz::text_of(data, size));
  fuzz::read_or_refuse(path, [&] {
    const inverse::TransportCache cache = inverse::load_transport_cache(path);
    CHIARO_CHECK(cache.indirect.size() == cache.visibility.size());
  });
  return 0;
}

// Caches, whole and unfinished, as solves, resumed bakes and merges read them.

#include <algorithm>
#include <array>

#include "inverse/transport/bake_file.h"
#include "inverse/transport/transport_cache.h"
#include "tests/fuzz/input_file.h"

namespace {

using namespace chiaro;

// Whatever tiles there are, as a bake that goes on takes them over.
void read_tiles(const std::filesystem::path& path) {
  inverse::TransportCacheReader reader(path);
  const std::size_t lights = reader.header().grid.positions.size(), tile = inverse::TransportCacheWriter::kLights;
  for (std::size_t light = 0; light < lights; light += tile) {
    inverse::TransportBlock block;
    block.first_light = light, block.light_count = std::min(tile, lights - light);
    block.first_receiver = reader.first_receiver();
    block.receiver_count = reader.last_receiver() - reader.first_receiver();
    if (!reader.read(block)) return;
    CHIARO_CHECK(block.indirect.size() == block.light_count * block.receiver_count);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path path = fuzz::input_file("cache.exr", fuzz::text_of(data, size));
  fuzz::read_or_refuse(path, [&] {
    const inverse::TransportCache cache = inverse::load_transport_cache(path);
    CHIARO_CHECK(cache.indirect.size() == cache.visibility.size());
  });
  fuzz::read_or_refuse(path, [&] { read_tiles(path); });
  fuzz::read_or_refuse(path,
                       [&] { inverse::merge_transport_caches(std::array{path}, fuzz::folder() / "merged.exr", {}); });
  return 0;
}

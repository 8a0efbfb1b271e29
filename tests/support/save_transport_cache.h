#pragma once

#include <algorithm>

#include "inverse/transport/transport_cache.h"
#include "renderer/core/atomic_file.h"

namespace chiaro::inverse {

// A cache in memory to a file, as a bake writes it.
inline void save_transport_cache(const TransportCache& cache, const std::filesystem::path& path) {
  renderer::write_atomically(path, [&](const std::filesystem::path& aside) {
    TransportCacheWriter writer(aside, cache, 0, cache.receiver_count);
    const std::size_t lights = cache.grid.positions.size();
    for (std::size_t first = 0; first < lights; first += TransportCacheWriter::kLights) {
      TransportBlock block{first, std::min(lights - first, TransportCacheWriter::kLights), 0, cache.receiver_count, {},
                           {}};
      const auto from = std::ptrdiff_t(first * cache.receiver_count);
      const auto to = from + std::ptrdiff_t(block.light_count * cache.receiver_count);
      block.visibility.assign(cache.visibility.begin() + from, cache.visibility.begin() + to);
      block.indirect.assign(cache.indirect.begin() + from, cache.indirect.begin() + to);
      writer.write(block);
    }
    writer.close();
  });
}

}  // namespace chiaro::inverse

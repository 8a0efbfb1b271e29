#pragma once
// What a cache's file says beside its entries, as attributes of the picture. docs/caches.md has all of it.

#include <string>

#include "inverse/transport/transport_cache.h"
#include "renderer/image/image_file.h"

namespace chiaro::inverse {

inline constexpr const char* kNotACache = "a transport cache made by `chiaro bake`";

renderer::Attributes transport_cache_attributes(const TransportCache& cache);

// All but the entries. `receivers`, `lights`: as the picture's size has them; `name` of the file, for errors. Error
// where anything is missing, does not fit together, or is of another version of the format.
TransportCache transport_cache_from(const renderer::Attributes& attributes, int receivers, int lights,
                                    const std::string& name);

}  // namespace chiaro::inverse

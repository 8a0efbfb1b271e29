#pragma once
// EXT_meshopt_compression: buffer views that were compressed by meshoptimizer.

#include "renderer/io/gltf_document.h"

namespace chiaro::renderer {

// Fills `document.decoded_views` with the contents of every compressed buffer view, filters applied; whether the file
// also has them uncompressed does not matter. On all threads. Error, naming the buffer view, for data that are damaged,
// and for sizes that such data cannot have.
void decode_meshopt_views(GltfDocument& document);

}  // namespace chiaro::renderer

#pragma once
// KHR_draco_mesh_compression: primitives that were compressed by Draco.

#include "renderer/io/gltf_document.h"

namespace chiaro::renderer {

// Gives every compressed primitive of `document` accessors of its own that hold its decoded attributes and indices, so
// that it reads as any other. On all threads. Error, naming the primitive, for data that are damaged, that lack an
// attribute, or that would grow beyond all measure.
void decode_draco_primitives(GltfDocument& document);

}  // namespace chiaro::renderer

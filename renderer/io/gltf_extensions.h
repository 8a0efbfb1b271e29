#pragma once

#include "renderer/io/gltf_document.h"

namespace chiaro::renderer {

// Error for an extension that is required and not read here; a warning for each that is used, not read, and changes
// what is seen.
void check_extensions(GltfDocument& document);

}  // namespace chiaro::renderer

#pragma once

#include "renderer/image/image.h"

namespace chiaro::renderer {

// `image` in another size: a tent filter as wide as two pixels of the coarser of the two grids.
Image resize(const Image& image, int width, int height);

}  // namespace chiaro::renderer

#pragma once
// Pictures that are stored turned or mirrored, as cameras and scanners store them.

#include "renderer/image/image.h"

namespace chiaro::renderer {

// Whether a picture of this orientation (of TIFF 6.0 and Exif: 1 to 8) is as wide as its stored form is high.
bool is_turned(int orientation);

// The picture as it is to be seen. 1, and what is no orientation: as stored.
Image upright(Image stored, int orientation);

}  // namespace chiaro::renderer

#include "renderer/image/image_orientation.h"

#include <algorithm>
#include <utility>

namespace chiaro::renderer {
namespace {

struct Pixel {
  int x, y;
};

// Where the pixel of the picture is stored.
Pixel stored_at(int x, int y, const Image& stored, int orientation) {
  const int last_x = stored.width - 1, last_y = stored.height - 1;
  switch (orientation) {
    case 2:
      return {last_x - x, y};
    case 3:
      return {last_x - x, last_y - y};
    case 4:
      return {x, last_y - y};
    case 5:
      return {y, x};
    case 6:
      return {y, last_y - x};
    case 7:
      return {last_x - y, last_y - x};
    case 8:
      return {last_x - y, x};
    default:
      return {x, y};
  }
}

}  // namespace

bool is_turned(int orientation) { return orientation >= 5 && orientation <= 8; }

Image upright(Image stored, int orientation) {
  if (orientation < 2 || orientation > 8) return stored;
  int width = stored.width, height = stored.height;
  if (is_turned(orientation)) std::swap(width, height);
  Image picture = make_image(width, height, stored.channel_names);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Pixel from = stored_at(x, y, stored, orientation);
      std::copy_n(stored.at(from.x, from.y), stored.channel_count(), picture.at(x, y));
    }
  }
  return picture;
}

}  // namespace chiaro::renderer

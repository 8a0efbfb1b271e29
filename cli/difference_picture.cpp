#include "cli/difference_picture.h"

#include <cmath>

#include "cli/output_paths.h"

namespace chiaro::cli {
namespace {

using renderer::Image;

constexpr float kDifferenceGain = 8;

// R, G, B; a single channel counts as grey.
Image colors_of(const Image& image) {
  Image colors = renderer::make_image(image.width, image.height, {"R", "G", "B"});
  const bool grey = image.channel_count() == 1;
  const int channels[3] = {grey ? 0 : image.find_channel("R"), grey ? 0 : image.find_channel("G"),
                           grey ? 0 : image.find_channel("B")};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < 3; ++c) colors.at(x, y)[c] = image.at(x, y)[channels[c]];
    }
  }
  return colors;
}

Image difference_of(const Image& a, const Image& b) {
  Image difference = a;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    difference.pixels[i] = kDifferenceGain * std::abs(a.pixels[i] - b.pixels[i]);
  }
  return difference;
}

void paste(const Image& panel, int left, Image& picture) {
  for (int y = 0; y < panel.height; ++y) {
    std::copy(panel.at(0, y), panel.at(0, y) + std::ptrdiff_t(panel.width) * 3, picture.at(left, y));
  }
}

}  // namespace

bool is_scene_linear(const std::filesystem::path& file) {
  return has_extension(file, {".exr", ".hdr", ".pfm", ".rgbe"});
}

Image scene_linear_picture(const Image& a, const Image& b, ViewChoice view) {
  const Image colors_a = colors_of(a), colors_b = colors_of(b);
  if (view.auto_exposure) view.view.exposure = auto_exposure(colors_b);
  view.auto_exposure = false;
  Image picture = renderer::make_image(3 * a.width, a.height, {"R", "G", "B"});
  paste(displayed(colors_a, view), 0, picture);
  paste(displayed(colors_b, view), a.width, picture);
  paste(displayed(difference_of(colors_a, colors_b), view), 2 * a.width, picture);
  return picture;
}

}  // namespace chiaro::cli

#include "renderer/image/scene_linear.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "renderer/core/error.h"
#include "renderer/image/known_primaries.h"
#include "renderer/image/srgb_curve.h"

namespace chiaro::renderer {
namespace {

std::array<int, 3> color_channels(const Image& image, const std::string& file) {
  const std::array<int, 3> rgb{image.find_channel("R"), image.find_channel("G"), image.find_channel("B")};
  if (min_component({float(rgb[0]), float(rgb[1]), float(rgb[2])}) >= 0) return rgb;
  const bool grey = image.channel_count() == 1 || (image.channel_count() == 2 && image.find_channel("A") == 1);
  if (grey) return {0, 0, 0};
  throw Error({file, "channels", fmt::format("are {}", fmt::join(image.channel_names, ", ")).substr(0, 200),
               "R, G and B, or a single one"});
}

const std::array<float, 8>* chromaticities_attribute(const Attributes& attributes) {
  for (const auto& [name, value] : attributes) {
    if (name == "chromaticities") return std::get_if<std::array<float, 8>>(&value);
  }
  return nullptr;
}

Rec709FromSpace rec709_from_file(const ImageFile& image, const std::string& file) {
  const std::array<float, 8>* chromaticities = chromaticities_attribute(image.attributes);
  if (chromaticities == nullptr) return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const Rec709FromSpace matrix = rec709_from_chromaticities(*chromaticities);
  for (const auto& row : matrix) {
    for (const double entry : row) {
      if (!std::isfinite(entry))
        throw Error({file, "chromaticities", "span no colours", "three primaries and a white"});
    }
  }
  return matrix;
}

Vec3f multiply(const Rec709FromSpace& m, Vec3f color) {
  Vec3f product;
  for (int i = 0; i < 3; ++i) {
    product[i] = float(m[i][0] * double(color.x) + m[i][1] * double(color.y) + m[i][2] * double(color.z));
  }
  return product;
}

}  // namespace

std::vector<Vec3f> scene_linear_rec709(const ImageFile& file, const std::string& name) {
  const std::array<int, 3> channels = color_channels(file.image, name);
  const bool converted = chromaticities_attribute(file.attributes) != nullptr;
  const Rec709FromSpace matrix = rec709_from_file(file, name);
  const std::size_t stride = file.image.channel_names.size();
  std::vector<Vec3f> colors(std::size_t(file.image.width) * std::size_t(file.image.height));
  for (std::size_t i = 0; i < colors.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float value = file.image.pixels[i * stride + std::size_t(channels[std::size_t(c)])];
      colors[i][c] = file.srgb_curve ? linear_from_srgb(value) : value;
    }
    if (converted) colors[i] = multiply(matrix, colors[i]);
  }
  return colors;
}

}  // namespace chiaro::renderer

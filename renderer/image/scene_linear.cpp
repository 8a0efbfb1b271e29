#include "renderer/image/scene_linear.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "renderer/core/error.h"
#include "renderer/core/shortened.h"
#include "renderer/image/color_management.h"
#include "renderer/image/known_primaries.h"
#include "renderer/image/srgb_curve.h"

namespace chiaro::renderer {
namespace {

std::array<int, 3> color_channels(const Image& image, const std::string& file) {
  const std::array<int, 3> rgb{image.find_channel("R"), image.find_channel("G"), image.find_channel("B")};
  if (min_component({float(rgb[0]), float(rgb[1]), float(rgb[2])}) >= 0) return rgb;
  if (is_grey(image)) return {0, 0, 0};
  throw Error({file, "channels", fmt::format("are {}", fmt::join(image.channel_names, ", ")).substr(0, 200),
               "R, G and B, or a single one"});
}

const std::array<float, 8>* chromaticities_attribute(const Attributes& attributes) {
  for (const auto& [name, value] : attributes) {
    if (name == "chromaticities") return std::get_if<std::array<float, 8>>(&value);
  }
  return nullptr;
}

// Of a matrix between colours: a hundred times what primaries in use need.
constexpr double kLargestEntry = 1e3;

Rec709FromSpace rec709_from_file(const ImageFile& image, const std::string& file) {
  const std::array<float, 8>* chromaticities = chromaticities_attribute(image.attributes);
  if (chromaticities == nullptr) return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const Rec709FromSpace matrix = rec709_from_chromaticities(*chromaticities);
  for (const auto& row : matrix) {
    for (const double entry : row) {
      if (!(std::abs(entry) <= kLargestEntry))
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

bool is_identity(const Rec709FromSpace& m) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (std::abs(m[i][j] - (i == j ? 1 : 0)) > 1e-3) return false;
    }
  }
  return true;
}

Image converted_from(const std::string& space, const ImageFile& file, const std::string& name,
                     const std::optional<std::filesystem::path>& config) {
  Image colors = stored_colors(file.image, name);
  try {
    convert_to_rec709(colors, find_ocio_config(config), space);
  } catch (const Error& error) {
    throw Error({name, kColorSpaceAttribute,
                 fmt::format("is \"{}\", but {}: {}", shortened(space, 200), error.parts().file, error.parts().problem),
                 "the OpenColorIO config that it was written with, by --ocio or $OCIO"});
  }
  return colors;
}

std::vector<Vec3f> vectors_of(const Image& rgb) {
  std::vector<Vec3f> colors(rgb.pixels.size() / 3);
  for (std::size_t i = 0; i < rgb.pixels.size(); ++i) colors[i / 3][int(i % 3)] = rgb.pixels[i];
  return colors;
}

}  // namespace

std::string named_space(const ImageFile& image) {
  if (image.whole_numbers || chromaticities_attribute(image.attributes) != nullptr) return "";
  for (const auto& [name, value] : image.attributes) {
    const auto* space = std::get_if<std::string>(&value);
    if (name == kColorSpaceAttribute && space != nullptr) return *space;
  }
  return "";
}

std::vector<Vec3f> scene_linear_rec709(const ImageFile& file, const std::string& name,
                                       const std::optional<std::filesystem::path>& config) {
  if (const std::string space = named_space(file); !space.empty()) {
    return vectors_of(converted_from(space, file, name, config));
  }
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

Image stored_colors(const Image& image, const std::string& file) {
  const std::array<int, 3> channels = color_channels(image, file);
  Image colors = make_image(image.width, image.height, {"R", "G", "B"});
  const std::size_t stride = image.channel_names.size();
  for (std::size_t i = 0; i < colors.pixels.size(); ++i) {
    colors.pixels[i] = image.pixels[i / 3 * stride + std::size_t(channels[i % 3])];
  }
  return colors;
}

// Depth and alpha alone are no colours.
bool is_grey(const Image& image) {
  const std::string name = image.channel_names.empty() ? "" : image.channel_names[0];
  for (const char* other : {"A", "Z", "ZBack", "depth", "Depth"}) {
    if (name == other || name.ends_with(std::string(".") + other)) return false;
  }
  return image.channel_count() == 1 || (image.channel_count() == 2 && image.find_channel("A") == 1);
}

bool has_other_primaries(const ImageFile& image, const std::string& file) {
  return !is_identity(rec709_from_file(image, file));
}

}  // namespace chiaro::renderer

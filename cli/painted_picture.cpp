#include "cli/painted_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "renderer/core/error.h"
#include "renderer/image/image_file.h"
#include "renderer/image/scene_linear.h"

namespace chiaro::cli {
namespace {

using renderer::Image;
using renderer::Vec3f;

constexpr float kWhite = 1 - 0.5F / 255;  // or more, as displays show it

float weight_of(float alpha) { return std::isfinite(alpha) ? std::clamp(alpha, 0.0F, 1.0F) : 0; }

// R, G, B, A; a grey picture has three alike, and one without alpha is opaque.
Image colors_and_alpha(const Image& image, const std::string& file) {
  const bool grey = image.find_channel("R") < 0;
  std::array<int, 3> color{};
  for (int c = 0; c < 3; ++c) {
    color[std::size_t(c)] = grey ? std::max(image.find_channel("Y"), 0) : image.find_channel(std::string(1, "RGB"[c]));
  }
  const bool one_grey = image.channel_count() <= 2 && (image.find_channel("Y") >= 0 || renderer::is_grey(image));
  if (*std::min_element(color.begin(), color.end()) < 0 || (grey && !one_grey)) {
    throw renderer::Error({file, "channels", "has no colours", "R, G and B, or one grey channel"});
  }
  const int alpha = image.find_channel("A");
  Image result = renderer::make_image(image.width, image.height, {"R", "G", "B", "A"});
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < 3; ++c) result.at(x, y)[c] = image.at(x, y)[color[std::size_t(c)]];
      result.at(x, y)[3] = alpha < 0 ? 1 : image.at(x, y)[alpha];
    }
  }
  return result;
}

// Of colours as stored, before they are decoded. Whole numbers are no more than white.
void divide_by_alpha(renderer::ImageFile& picture) {
  std::vector<float>& pixels = picture.image.pixels;
  for (std::size_t first = 0; first < pixels.size(); first += 4) {
    const float alpha = weight_of(pixels[first + 3]);
    for (std::size_t i = first; i < first + 3 && alpha > 0; ++i) {
      pixels[i] *= 1 / alpha;
      if (picture.whole_numbers) pixels[i] = std::min(pixels[i], 1.0F);
    }
  }
}

// R, G, B, A, the colours not multiplied by it, whatever the file has.
renderer::ImageFile load_colors(const std::string& file) {
  renderer::ImageFile picture = renderer::load_image(file);
  picture.image = colors_and_alpha(picture.image, file);
  if (std::exchange(picture.associated_alpha, false)) divide_by_alpha(picture);
  return picture;
}

Vec3f color_at(const Image& image, int x, int y) {
  const float* pixel = image.at(x, y);
  return {pixel[0], pixel[1], pixel[2]};
}

// What `decode` makes of a picture that is white all over.
template <class Decode>
Vec3f white_of(const Decode& decode) {
  Image white = renderer::make_image(1, 1, {"R", "G", "B", "A"});
  white.pixels.assign(4, 1.0F);
  decode(white);
  return color_at(white, 0, 0);
}

void set_alpha(const Image& image, PaintedPicture& picture) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) picture.weight.push_back(weight_of(image.at(x, y)[3]));
  }
}

void leave_out_white(const Image& image, bool keep_white, PaintedPicture& picture) {
  for (std::size_t i = 0; i < picture.weight.size(); ++i) {
    const Vec3f color = color_at(image, int(i) % image.width, int(i) / image.width);
    if (picture.weight[i] <= 0 || max_component(color) < kWhite) continue;
    ++picture.white_pixels;
    if (!keep_white) picture.weight[i] = 0;
  }
}

template <class Decode>
void decode_pixels(const Image& stored, const Decode& decode, PaintedPicture& picture) {
  Image linear = stored;
  decode(linear);
  for (int y = 0; y < linear.height; ++y) {
    for (int x = 0; x < linear.width; ++x) picture.pixels.push_back(color_at(linear, x, y));
  }
  picture.white = white_of(decode);
}

void decode_display(const Image& stored, const PictureEncoding& encoding, PaintedPicture& picture) {
  const auto config = renderer::find_ocio_config(encoding.view.config);
  const auto decode = [&](Image& image) {
    image = renderer::to_rec709_from_display_view(image, config, encoding.view.view);
  };
  decode_pixels(stored, decode, picture);
  leave_out_white(stored, encoding.keep_white, picture);
  picture.encoding =
      encoding.view.view.view.empty() ? "through the default view" : "through " + encoding.view.view.view;
}

void decode_space(const renderer::ImageFile& stored, const PictureEncoding& encoding, PaintedPicture& picture) {
  const auto config = renderer::find_ocio_config(encoding.view.config);
  const auto decode = [&](Image& image) { renderer::convert_to_rec709(image, config, encoding.space); };
  decode_pixels(stored.image, decode, picture);
  if (stored.whole_numbers) leave_out_white(stored.image, encoding.keep_white, picture);
  picture.encoding = "in " + encoding.space;
}

void undo_exposure(float exposure, PaintedPicture& picture) {
  const float gain = std::exp2(-exposure);
  for (Vec3f& pixel : picture.pixels) pixel *= gain;
  picture.white *= gain;
}

}  // namespace

PaintedPicture load_painted_picture(const std::string& file, const PictureEncoding& encoding) {
  const renderer::ImageFile stored = load_colors(file);
  const Image& image = stored.image;
  PaintedPicture picture;
  picture.width = image.width;
  picture.height = image.height;
  set_alpha(image, picture);
  if (!encoding.space.empty()) {
    decode_space(stored, encoding, picture);
    undo_exposure(encoding.view.view.exposure, picture);
  } else if (!stored.whole_numbers) {
    const std::string space = renderer::named_space(stored);
    picture.pixels = renderer::scene_linear_rec709(stored, file, encoding.view.config);
    picture.white = {1, 1, 1};
    picture.encoding = space.empty() ? "scene-linear" : "in " + space;
    undo_exposure(encoding.view.view.exposure, picture);
  } else {
    decode_display(image, encoding, picture);
  }
  return picture;
}

std::vector<float> load_mask(const std::string& file, int width, int height) {
  const Image mask = load_colors(file).image;
  if (mask.width != width || mask.height != height) {
    throw renderer::Error({file, "size", fmt::format("is {} x {}", mask.width, mask.height),
                           fmt::format("{} x {}, as the picture that it masks", width, height)});
  }
  std::vector<float> weight;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      weight.push_back(weight_of(luminance(color_at(mask, x, y)) * mask.at(x, y)[3]));
    }
  }
  return weight;
}

}  // namespace chiaro::cli

#include "cli/painted_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "renderer/core/error.h"
#include "renderer/image/image_file.h"
#include "renderer/image/scene_linear.h"

namespace chiaro::cli {
namespace {

using renderer::Image;
using renderer::Vec3f;

constexpr float kWhite = 1 - 0.5F / 255;  // or more, as displays show it

// R, G, B, A; a grey picture has three alike, and one without alpha is opaque.
Image colors_and_alpha(const Image& image, const std::string& file) {
  const bool grey = image.find_channel("R") < 0;
  std::array<int, 3> color{};
  for (int c = 0; c < 3; ++c) {
    color[std::size_t(c)] = grey ? std::max(image.find_channel("Y"), 0) : image.find_channel(std::string(1, "RGB"[c]));
  }
  if (*std::min_element(color.begin(), color.end()) < 0 || (grey && image.channel_count() > 2)) {
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

// Of a scene-linear picture with alpha the colours are multiplied by it, as OpenEXR has it.
void divide_by_alpha(PaintedPicture& picture) {
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    if (picture.weight[i] > 0) picture.pixels[i] *= 1 / picture.weight[i];
  }
}

void set_alpha(const Image& image, PaintedPicture& picture) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float alpha = image.at(x, y)[3];
      picture.weight.push_back(std::isfinite(alpha) ? std::clamp(alpha, 0.0F, 1.0F) : 0);
    }
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

void decode_space(const Image& stored, const PictureEncoding& encoding, PaintedPicture& picture) {
  const auto config = renderer::find_ocio_config(encoding.view.config);
  const auto decode = [&](Image& image) { renderer::convert_to_rec709(image, config, encoding.space); };
  decode_pixels(stored, decode, picture);
  picture.encoding = "in " + encoding.space;
}

void undo_exposure(float exposure, PaintedPicture& picture) {
  const float gain = std::exp2(-exposure);
  for (Vec3f& pixel : picture.pixels) pixel *= gain;
  picture.white *= gain;
}

}  // namespace

PaintedPicture load_painted_picture(const std::string& file, const PictureEncoding& encoding) {
  const renderer::ImageFile stored = renderer::load_image(file);
  const Image image = colors_and_alpha(stored.image, file);
  PaintedPicture picture;
  picture.width = image.width;
  picture.height = image.height;
  set_alpha(image, picture);
  if (!encoding.space.empty()) {
    decode_space(image, encoding, picture);
    undo_exposure(encoding.view.view.exposure, picture);
  } else if (!stored.whole_numbers) {
    const std::string space = renderer::named_space(stored);
    picture.pixels = renderer::scene_linear_rec709(stored, file, encoding.view.config);
    picture.white = {1, 1, 1};
    picture.encoding = space.empty() ? "scene-linear" : "in " + space;
    divide_by_alpha(picture);
    undo_exposure(encoding.view.view.exposure, picture);
  } else {
    decode_display(image, encoding, picture);
  }
  return picture;
}

std::vector<float> load_mask(const std::string& file, int width, int height) {
  const Image mask = colors_and_alpha(renderer::load_image(file).image, file);
  if (mask.width != width || mask.height != height) {
    throw renderer::Error({file, "size", fmt::format("is {} x {}", mask.width, mask.height),
                           fmt::format("{} x {}, as the picture that it masks", width, height)});
  }
  std::vector<float> weight;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float value = luminance(color_at(mask, x, y)) * mask.at(x, y)[3];
      weight.push_back(std::isfinite(value) ? std::clamp(value, 0.0F, 1.0F) : 0);
    }
  }
  return weight;
}

}  // namespace chiaro::cli

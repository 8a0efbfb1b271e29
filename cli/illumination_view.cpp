#include "cli/illumination_view.h"

#include <CLI/CLI.hpp>

#include "cli/add_options.h"
#include "cli/output_paths.h"
#include "cli/usage_error.h"
#include "renderer/core/file_extension.h"
#include "renderer/image/image_file.h"

namespace chiaro::cli {
namespace {

using renderer::Image;

constexpr float kDifferenceGain = 8;
constexpr int kStripe = 5;                                  // pixels
constexpr float kDarkStripe = 0.36F, kLightStripe = 0.42F;  // on the display

float hatching(int x, int y) { return (x + y) / kStripe % 2 == 0 ? kDarkStripe : kLightStripe; }

template <class Write>
Image with_pixels(int width, int height, std::vector<std::string> channels, const Write& write) {
  Image image = renderer::make_image(width, height, std::move(channels));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) write(x, y, image.at(x, y));
  }
  return image;
}

bool is_exr(const std::string& file) { return renderer::has_extension(file, {".exr"}); }

}  // namespace

Image colors_of(const Image& picture) {
  return with_pixels(picture.width, picture.height, {"R", "G", "B"}, [&](int x, int y, float* pixel) {
    const float* from = picture.at(x, y);
    for (int c = 0; c < 3 && from[3] > 0; ++c) pixel[c] = from[c] / from[3];
  });
}

Image displayed_illumination(const Image& picture, const ViewChoice& view) {
  Image shown = displayed(colors_of(picture), view);
  for (int y = 0; y < shown.height; ++y) {
    for (int x = 0; x < shown.width; ++x) {
      const float alpha = picture.at(x, y)[3];
      for (int c = 0; c < 3; ++c) shown.at(x, y)[c] = std::lerp(hatching(x, y), shown.at(x, y)[c], alpha);
    }
  }
  return shown;
}

Image illumination_difference(const Image& a, const Image& b) {
  const Image of_a = colors_of(a), of_b = colors_of(b);
  return with_pixels(a.width, a.height, {"R", "G", "B", "A"}, [&](int x, int y, float* pixel) {
    const float alpha = std::min(a.at(x, y)[3], b.at(x, y)[3]);
    for (int c = 0; c < 3; ++c) {
      pixel[c] = alpha * kDifferenceGain * std::abs(of_a.at(x, y)[c] - of_b.at(x, y)[c]);
    }
    pixel[3] = alpha;
  });
}

void add_illumination_picture_options(CLI::App& command, IlluminationPictureOptions& options) {
  add_parsed(command,
             {"--picture", "P.png|P.exr",
              "The illumination as a camera sees it, too: of white surfaces, hatched where none is known (.exr, .png, "
              ".jpg, .jpeg, .tif or .tiff)"},
             [&options](const std::string& text) {
               require_extension(text, {".exr", ".png", ".jpg", ".jpeg", ".tif", ".tiff"});
               options.file = text;
             });
  add_text(command, {"--camera", "NAME", "Camera of the picture (default: the scene's first)"}, options.camera);
  add_count(command, {"--width", "W", "Pixels across of the picture (default 960)"}, options.size.width, {1, 1 << 16});
  add_count(command, {"--height", "H", "Pixels down of the picture (default: from the camera's aspect ratio)"},
            options.size.height, {1, 1 << 16});
  add_view_options(command, options.view);
}

void require_picture(const IlluminationPictureOptions& options) {
  if (!options.file.empty() && !is_exr(options.file)) require_view(options.view);
}

std::optional<PictureCamera> choose_picture_camera(const IlluminationPictureOptions& options,
                                                   const renderer::Scene& scene, Session& session) {
  if (options.file.empty()) return std::nullopt;
  const renderer::Camera camera = choose_camera(scene, options.camera, options.size, session);
  const auto [width, height] = frame_size(camera, options.size);
  renderer::require_room_for(width, height, options.file);
  return PictureCamera{camera, width, height};
}

void save_illumination_picture(const IlluminationPictureOptions& options, const Image& picture) {
  if (is_exr(options.file)) {
    renderer::save_image(picture, options.file, renderer::PixelType::kFloat);
  } else {
    renderer::save_image(displayed_illumination(picture, options.view), options.file, renderer::PixelType::kUint8);
  }
}

}  // namespace chiaro::cli

#include "cli/frame_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "cli/option_values.h"
#include "cli/usage_error.h"

namespace chiaro::cli {
namespace {

using renderer::Image;

bool finite_pixel(const Image& image, std::size_t i) {
  const float* pixel = &image.pixels[3 * i];
  return std::isfinite(pixel[0]) && std::isfinite(pixel[1]) && std::isfinite(pixel[2]);
}

// Without pixels that are not finite in both frames: of `image` they become `value`.
Image without_bad_pixels(Image image, const ComparedFrames& frames, float value) {
  const std::size_t channels = image.channel_names.size();
  for (std::size_t i = 0; i * channels < image.pixels.size(); ++i) {
    if (finite_pixel(frames.a, i) && finite_pixel(frames.b, i)) continue;
    std::fill_n(image.pixels.begin() + std::ptrdiff_t(i * channels), channels, value);
  }
  return image;
}

// They have no FLIP …
Image left_out(Image flip, const ComparedFrames& frames) {
  return without_bad_pixels(std::move(flip), frames, std::numeric_limits<float>::quiet_NaN());
}

// … nor a part in that of their neighbours.
Image same_where_bad(const Image& image, const ComparedFrames& frames) { return without_bad_pixels(image, frames, 0); }

FrameFigures figures_of(const ComparedFrames& frames, const FrameComparison& found,
                        const std::optional<renderer::PixelRegion>& region) {
  FrameFigures figures;
  const std::optional<double> peak = frames.scene_linear ? std::optional<double>() : 1.0;
  figures.image = renderer::compare_images(frames.a, frames.b, {.region = region, .peak = peak});
  if (found.panels.flip) figures.flip = renderer::mean_value(*found.panels.flip, region);
  if (found.hdr_flip.exposures > 0) figures.flip_hdr = renderer::mean_value(found.hdr_flip.error, region);
  return figures;
}

renderer::ComparisonPanels panels_of(const ComparedFrames& frames, const ViewChoice& view) {
  const Image difference = renderer::magnified_difference(frames.a, frames.b);
  if (!frames.scene_linear) return {frames.a, frames.b, difference, {}};
  return {displayed(frames.a, view), displayed(frames.b, view), displayed(difference, view), {}};
}

void add_flip(const ComparedFrames& frames, double pixels_per_degree, const renderer::Control& control,
              FrameComparison& found) {
  const renderer::ComparisonPanels& shown = found.panels;
  found.panels.flip = left_out(
      renderer::flip(same_where_bad(shown.a, frames), same_where_bad(shown.b, frames), pixels_per_degree, control),
      frames);
  if (!frames.scene_linear) return;
  found.hdr_flip = renderer::hdr_flip(same_where_bad(frames.a, frames), same_where_bad(frames.b, frames),
                                      pixels_per_degree, control);
  found.hdr_flip.error = left_out(std::move(found.hdr_flip.error), frames);
}

}  // namespace

NamedRegion parse_region(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  const bool named = equals != std::string::npos && equals > 0;
  const std::vector<double> v =
      parse_numbers(named ? std::string_view(text).substr(equals + 1) : text, 4, {.min = 0, .max = 1 << 24});
  const bool whole = std::all_of(v.begin(), v.end(), [](double corner) { return corner == std::floor(corner); });
  if (!whole || v[0] >= v[2] || v[1] >= v[3]) {
    throw UsageError(fmt::format("'{}' (expected whole numbers, x0 < x1 and y0 < y1)", text));
  }
  return {named ? text.substr(0, equals) : text, {int(v[0]), int(v[1]), int(v[2]), int(v[3])}};
}

FrameComparison compare_frames(const ComparedFrames& frames, const FrameComparisonOptions& options,
                               const renderer::Control& control) {
  FrameComparison found;
  found.scene_linear = frames.scene_linear;
  found.exposure = frames.exposure;
  if (options.picture || !options.no_flip) {
    const ViewChoice view = frames.scene_linear ? exposed_for(frames.b, options.view) : options.view;
    if (frames.scene_linear) found.exposure = view.view.exposure;
    found.panels = panels_of(frames, view);
  }
  if (!options.no_flip) add_flip(frames, options.pixels_per_degree, control, found);
  found.whole = figures_of(frames, found, {});
  found.regions = options.regions;
  for (const NamedRegion& region : options.regions) {
    found.of_regions.push_back(figures_of(frames, found, region.pixels));
  }
  return found;
}

}  // namespace chiaro::cli

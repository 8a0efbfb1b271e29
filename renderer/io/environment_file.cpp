#include "renderer/io/environment_file.h"

#include <algorithm>

#include <fmt/format.h>

#include "renderer/core/counted.h"
#include "renderer/core/error.h"
#include "renderer/core/world_limits.h"
#include "renderer/image/scene_linear.h"

namespace chiaro::renderer {
namespace {

constexpr std::int64_t kMostPixels = std::int64_t{1} << 27;
constexpr float kMaxHalf = 65504.0F;

void check_size(const Image& header, const std::string& file) {
  if (std::int64_t(header.width) * header.height <= kMostPixels) return;
  throw Error({file, "header", fmt::format("{} x {} pixels", header.width, header.height), "at most 16384 x 8192"});
}

// Saturated colours of wider spaces are a little negative in Rec.709, which is no fault of the file.
bool is_mendable_rounding(Vec3f color) {
  return max_component(color) <= kBrightest && is_finite(color) &&
         min_component(color) >= -0.25F * max_component(color);
}

float mended(float value) { return std::isnan(value) ? 0 : std::clamp(value, 0.0F, kMaxHalf); }

void warn_of_shape(const EnvironmentMap& map, const std::string& file, std::vector<std::string>& warnings) {
  if (map.width == 2 * map.height) return;
  warnings.push_back(
      fmt::format("{}: {} x {} pixels are stretched over all directions (twice as wide as high is usual)", file,
                  map.width, map.height));
}

}  // namespace

std::size_t mend_pixels(EnvironmentMap& map) {
  std::size_t count = 0;
  for (Vec3f& color : map.pixels) {
    if (is_light(color)) continue;
    if (!is_mendable_rounding(color)) ++count;
    for (int c = 0; c < 3; ++c) {
      if (!std::isfinite(color[c]) || color[c] < 0) color[c] = mended(color[c]);
      color[c] = std::min(color[c], kBrightest);
    }
  }
  return count;
}

EnvironmentLight load_environment(const std::filesystem::path& path, std::vector<std::string>& warnings,
                                  const std::optional<std::filesystem::path>& config) {
  const std::string file = path.string();
  check_size(load_image_header(path).image, file);
  const ImageFile image = load_image(path);
  EnvironmentMap map{image.image.width, image.image.height, scene_linear_rec709(image, file, config)};
  if (const std::size_t count = mend_pixels(map); count > 0) {
    warnings.push_back(fmt::format("{}: {}", file,
                                   counted(count, "pixel is negative, not finite or too bright; it is mended",
                                           "pixels are negative, not finite or too bright; they are mended")));
  }
  const bool dark = std::all_of(map.pixels.begin(), map.pixels.end(), [](Vec3f p) { return !(max_component(p) > 0); });
  if (dark) throw Error({file, "pixels", "are all black", "an environment that gives light"});
  warn_of_shape(map, file, warnings);
  EnvironmentLight light;
  light.name = "environment";
  light.map = std::make_shared<const EnvironmentMap>(std::move(map));
  light.image = file;
  return light;
}

}  // namespace chiaro::renderer

#include "renderer/image/color_management.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "renderer/core/control.h"
#include "renderer/core/error.h"
#include "renderer/image/known_primaries.h"

namespace chiaro::renderer {
namespace {

namespace ocio = OCIO_NAMESPACE;

constexpr std::size_t kPixelsPerTask = 65536;

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

ocio::ConstConfigRcPtr load_config(const std::filesystem::path& path) {
  try {
    const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(path.c_str());
    config->validate();
    return config;
  } catch (const ocio::Exception& exception) {
    throw Error({path.string(), "", first_line(exception.what()), "an OpenColorIO config"});
  }
}

std::vector<std::string> color_spaces(const ocio::ConstConfigRcPtr& config) {
  std::vector<std::string> names;
  for (int i = 0; i < config->getNumColorSpaces(); ++i) names.emplace_back(config->getColorSpaceNameByIndex(i));
  return names;
}

// The config's scene-linear Rec.709: by the names that configs in use give it, or what they work in.
std::string rec709_space(const ocio::ConstConfigRcPtr& config, const std::filesystem::path& path) {
  for (const char* name : {"lin_rec709", "Linear Rec.709 (sRGB)", "lin_rec709_scene", "Linear Rec.709",
                           "Utility - Linear - sRGB", "Utility - Linear - Rec.709", "scene_linear"}) {
    if (config->getColorSpace(name)) return name;
  }
  throw Error({path.string(), "colorspaces", "has no scene-linear Rec.709",
               fmt::format("lin_rec709 or the role scene_linear, besides {}", fmt::join(color_spaces(config), ", "))});
}

void check_choice(const std::string& name, const std::vector<std::string>& choices, const std::string& place,
                  const std::filesystem::path& path) {
  if (std::find(choices.begin(), choices.end(), name) != choices.end()) return;
  throw Error({path.string(), place, fmt::format("\"{}\" is not in the config", name),
               fmt::format("one of {}", fmt::join(choices, ", "))});
}

std::vector<std::string> displays_of(const ocio::ConstConfigRcPtr& config) {
  std::vector<std::string> names;
  for (int i = 0; i < config->getNumDisplays(); ++i) names.emplace_back(config->getDisplay(i));
  return names;
}

std::vector<std::string> views_of(const ocio::ConstConfigRcPtr& config, const std::string& display) {
  std::vector<std::string> names;
  for (int i = 0; i < config->getNumViews(display.c_str()); ++i)
    names.emplace_back(config->getView(display.c_str(), i));
  return names;
}

template <class Transform>
ocio::ConstCPUProcessorRcPtr cpu_processor(const ocio::ConstConfigRcPtr& config, const Transform& transform,
                                           const std::filesystem::path& path) {
  try {
    return config->getProcessor(transform)->getDefaultCPUProcessor();
  } catch (const ocio::Exception& exception) {
    throw Error({path.string(), "", first_line(exception.what()), "a transform that works"});
  }
}

ocio::ConstCPUProcessorRcPtr view_processor(const ocio::ConstConfigRcPtr& config, const std::filesystem::path& path,
                                            const ViewOptions& options) {
  const std::string display = options.display.empty() ? config->getDefaultDisplay() : options.display;
  check_choice(display, displays_of(config), "display", path);
  const std::string view = options.view.empty() ? config->getDefaultView(display.c_str()) : options.view;
  check_choice(view, views_of(config, display), fmt::format("view of display \"{}\"", display), path);
  const ocio::DisplayViewTransformRcPtr transform = ocio::DisplayViewTransform::Create();
  transform->setSrc(rec709_space(config, path).c_str());
  transform->setDisplay(display.c_str());
  transform->setView(view.c_str());
  return cpu_processor(config, transform, path);
}

ocio::ConstCPUProcessorRcPtr space_processor(const ocio::ConstConfigRcPtr& config, const std::filesystem::path& path,
                                             const std::string& from, const std::string& to) {
  const ocio::ColorSpaceTransformRcPtr transform = ocio::ColorSpaceTransform::Create();
  transform->setSrc(from.c_str());
  transform->setDst(to.c_str());
  return cpu_processor(config, transform, path);
}

void check_space(const ocio::ConstConfigRcPtr& config, const std::string& space, const std::filesystem::path& path) {
  if (!config->getColorSpace(space.c_str())) check_choice(space, color_spaces(config), "colour space", path);
}

// RGB triples, one after the other.
void apply(const ocio::CPUProcessor& processor, std::vector<float>& rgb) {
  const std::size_t count = rgb.size() / 3;
  parallel_for((count + kPixelsPerTask - 1) / kPixelsPerTask, [&](std::size_t task) {
    const std::size_t first = task * kPixelsPerTask, size = std::min(kPixelsPerTask, count - first);
    ocio::PackedImageDesc pixels(&rgb[3 * first], long(size), 1, 3);
    processor.apply(pixels);
  });
}

using Triple = std::array<int, 3>;

std::vector<float> gather(const Image& image, const Triple& channels) {
  const std::size_t count = std::size_t(image.width) * image.height, stride = image.channel_names.size();
  std::vector<float> rgb(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < 3; ++c) rgb[3 * i + c] = image.pixels[i * stride + channels[c]];
  }
  return rgb;
}

void scatter(const std::vector<float>& rgb, const Triple& channels, Image& image) {
  const std::size_t stride = image.channel_names.size();
  for (std::size_t i = 0; 3 * i < rgb.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) image.pixels[i * stride + channels[c]] = rgb[3 * i + c];
  }
}

std::vector<Triple> color_triples(const Image& image, const std::vector<std::string>& color_layers) {
  std::vector<Triple> triples;
  if (image.channel_count() >= 3) triples.push_back({0, 1, 2});
  for (const std::string& layer : color_layers) {
    const std::string prefix = layer.empty() ? "" : layer + ".";
    const Triple triple{image.find_channel(prefix + "R"), image.find_channel(prefix + "G"),
                        image.find_channel(prefix + "B")};
    const bool found = *std::min_element(triple.begin(), triple.end()) >= 0;
    if (found && std::find(triples.begin(), triples.end(), triple) == triples.end()) triples.push_back(triple);
  }
  return triples;
}

float display_value(float value) { return std::isnan(value) ? 0 : std::clamp(value, 0.0F, 1.0F); }

std::optional<std::filesystem::path> data_config() {
  std::vector<std::filesystem::path> folders;
  if (const char* data = std::getenv("CHIARO_DATA")) folders.emplace_back(data);
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const std::filesystem::path prefix = program.parent_path().parent_path();
  if (!prefix.empty()) folders.insert(folders.end(), {prefix, prefix / "share" / "chiaro"});
  for (const std::filesystem::path& folder : folders) {
    const std::filesystem::path config = folder / "color" / "config.ocio";
    if (std::filesystem::is_regular_file(config, ignored)) return config;
  }
  return std::nullopt;
}

std::filesystem::path checked(const std::filesystem::path& config, const char* where) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(config, ignored)) return config;
  throw Error({config.string(), where, "no such file", "an OpenColorIO config"});
}

}  // namespace

std::filesystem::path find_ocio_config(const std::optional<std::filesystem::path>& explicit_config) {
  if (explicit_config) return checked(*explicit_config, "");
  if (const char* variable = std::getenv("OCIO"); variable && *variable) return checked(variable, "$OCIO");
  if (const auto config = data_config()) return *config;
  throw Error({"config.ocio", "", "no OpenColorIO config found", "--ocio, $OCIO, or $CHIARO_DATA/color/config.ocio"});
}

Image apply_display_view(const Image& image, const std::filesystem::path& config, const ViewOptions& options) {
  if (image.channel_count() < 3) {
    throw Error({"image", "", fmt::format("has {} channels", image.channel_count()), "at least R, G, B"});
  }
  const ocio::ConstCPUProcessorRcPtr processor = view_processor(load_config(config), config, options);
  std::vector<float> rgb = gather(image, {0, 1, 2});
  const float gain = std::exp2(options.exposure);
  for (float& value : rgb) value *= gain;
  apply(*processor, rgb);
  std::transform(rgb.begin(), rgb.end(), rgb.begin(), display_value);
  return {image.width, image.height, {"R", "G", "B"}, std::move(rgb)};
}

void convert_from_rec709(Image& image, const std::filesystem::path& config, const std::string& space,
                         const std::vector<std::string>& color_layers) {
  const ocio::ConstConfigRcPtr loaded = load_config(config);
  check_space(loaded, space, config);
  const auto processor = space_processor(loaded, config, rec709_space(loaded, config), space);
  for (const Triple& triple : color_triples(image, color_layers)) {
    std::vector<float> rgb = gather(image, triple);
    apply(*processor, rgb);
    scatter(rgb, triple, image);
  }
}

std::optional<std::array<float, 8>> chromaticities_of(const std::filesystem::path& config, const std::string& space) {
  const ocio::ConstConfigRcPtr loaded = load_config(config);
  check_space(loaded, space, config);
  const auto processor = space_processor(loaded, config, space, rec709_space(loaded, config));
  // Unit primaries, and twice as much of them: a linear space doubles.
  std::vector<float> rgb{1, 0, 0, 0, 1, 0, 0, 0, 1, 2, 0, 0, 0, 2, 0, 0, 0, 2};
  apply(*processor, rgb);
  Rec709FromSpace matrix{};
  for (std::size_t i = 0; i < 9; ++i) {
    if (!(std::abs(rgb[9 + i] - 2 * rgb[i]) <= 1e-3F)) return std::nullopt;
    matrix[i % 3][i / 3] = rgb[i];
  }
  return known_chromaticities(matrix);
}

}  // namespace chiaro::renderer

#include "renderer/image/color_management.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "renderer/core/control.h"
#include "renderer/core/error.h"
#include "renderer/core/first_line.h"
#include "renderer/core/vec.h"
#include "renderer/image/known_primaries.h"
#include "renderer/image/ocio_config.h"

namespace chiaro::renderer {
namespace {

namespace ocio = OCIO_NAMESPACE;

constexpr std::size_t kPixelsPerTask = 65536;
constexpr const char* kNoLook = "none";

std::vector<std::string> color_spaces(const ocio::ConstConfigRcPtr& config) {
  std::vector<std::string> names;
  for (int i = 0; i < config->getNumColorSpaces(); ++i) names.emplace_back(config->getColorSpaceNameByIndex(i));
  return names;
}

struct KnownSpace {
  const char* name;  // names that configs in use give it, or a role
  std::array<float, 8> chromaticities;
};

constexpr std::array<float, 8> kRec709{0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F};
constexpr std::array<float, 8> kAp0{0.7347F, 0.2653F, 0, 1, 0.0001F, -0.0770F, 0.32168F, 0.33767F};
constexpr std::array<float, 8> kAp1{0.713F, 0.293F, 0.165F, 0.830F, 0.128F, 0.044F, 0.32168F, 0.33767F};

constexpr KnownSpace kKnownSpaces[] = {{"lin_rec709", kRec709},
                                       {"Linear Rec.709 (sRGB)", kRec709},
                                       {"lin_rec709_scene", kRec709},
                                       {"lin_rec709_srgb", kRec709},
                                       {"Linear Rec.709", kRec709},
                                       {"lin_srgb", kRec709},
                                       {"Utility - Linear - sRGB", kRec709},
                                       {"Utility - Linear - Rec.709", kRec709},
                                       {"aces_interchange", kAp0},
                                       {"ACES2065-1", kAp0},
                                       {"ACES - ACES2065-1", kAp0},
                                       {"ACEScg", kAp1},
                                       {"ACES - ACEScg", kAp1},
                                       {"scene_linear", kRec709}};

// Where colours enter and leave the config: a scene-linear space whose primaries are known. The role scene_linear says
// nothing of its primaries, so it comes last, and then counts as Rec.709.
const KnownSpace& entry_space(const ocio::ConstConfigRcPtr& config, const std::filesystem::path& path) {
  for (const KnownSpace& space : kKnownSpaces) {
    if (config->getColorSpace(space.name)) return space;
  }
  throw Error({path.string(), "colorspaces", "has no scene-linear Rec.709",
               fmt::format("lin_rec709, or the role aces_interchange or scene_linear, besides {}",
                           fmt::join(color_spaces(config), ", "))});
}

void append_rec709_to(const KnownSpace& space, ocio::GroupTransform& group) {
  if (space.chromaticities == kRec709) return;
  const Rec709FromSpace matrix = rec709_from_chromaticities(space.chromaticities);
  double m44[16] = {};
  for (std::size_t i = 0; i < 3; ++i) std::copy(matrix[i].begin(), matrix[i].end(), m44 + 4 * i);
  m44[15] = 1;
  const ocio::MatrixTransformRcPtr transform = ocio::MatrixTransform::Create();
  transform->setMatrix(m44);
  transform->setDirection(ocio::TRANSFORM_DIR_INVERSE);
  group.appendTransform(transform);
}

void check_choice(const std::string& name, const std::vector<std::string>& choices, const std::string& place,
                  const std::filesystem::path& path) {
  if (std::find(choices.begin(), choices.end(), name) != choices.end()) return;
  throw Error({path.string(), place, fmt::format("\"{}\" is not in the config", name),
               choices.empty() ? fmt::format("none: the config has no {}", place)
                               : fmt::format("one of {}", fmt::join(choices, ", "))});
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

ocio::ConstCPUProcessorRcPtr cpu_processor(const ocio::ConstConfigRcPtr& config,
                                           const ocio::ConstTransformRcPtr& transform,
                                           const std::filesystem::path& path) {
  try {
    return config->getProcessor(transform)->getDefaultCPUProcessor();
  } catch (const ocio::Exception& exception) {
    throw Error({path.string(), "", first_line(exception.what()), "a transform that works"});
  }
}

std::vector<std::string> looks_of(const ocio::ConstConfigRcPtr& config) {
  std::vector<std::string> names;
  for (int i = 0; i < config->getNumLooks(); ++i) names.emplace_back(config->getLookNameByIndex(i));
  return names;
}

void append_look(const ocio::ConstConfigRcPtr& config, const std::filesystem::path& path, const std::string& look,
                 ocio::GroupTransform& group) {
  check_choice(look, looks_of(config), "look", path);
  const char* space = entry_space(config, path).name;
  const ocio::LookTransformRcPtr transform = ocio::LookTransform::Create();
  transform->setSrc(space);
  transform->setDst(space);
  transform->setLooks(look.c_str());
  group.appendTransform(transform);
}

// From scene-linear Rec.709 to the view.
ocio::GroupTransformRcPtr view_transform(const ocio::ConstConfigRcPtr& config, const std::filesystem::path& path,
                                         const ViewOptions& options) {
  const std::string display = options.display.empty() ? config->getDefaultDisplay() : options.display;
  check_choice(display, displays_of(config), "display", path);
  const std::string view = options.view.empty() ? config->getDefaultView(display.c_str()) : options.view;
  check_choice(view, views_of(config, display), fmt::format("view of display \"{}\"", display), path);
  ocio::GroupTransformRcPtr group = ocio::GroupTransform::Create();
  append_rec709_to(entry_space(config, path), *group);
  if (!options.look.empty() && options.look != kNoLook) append_look(config, path, options.look, *group);
  const ocio::DisplayViewTransformRcPtr transform = ocio::DisplayViewTransform::Create();
  transform->setSrc(entry_space(config, path).name);
  transform->setDisplay(display.c_str());
  transform->setView(view.c_str());
  transform->setLooksBypass(!options.look.empty());
  group->appendTransform(transform);
  return group;
}

// From scene-linear Rec.709 to a space; data is never converted.
ocio::GroupTransformRcPtr space_transform(const ocio::ConstConfigRcPtr& config, const std::filesystem::path& path,
                                          const std::string& space) {
  ocio::GroupTransformRcPtr group = ocio::GroupTransform::Create();
  if (config->getColorSpace(space.c_str())->isData()) return group;
  append_rec709_to(entry_space(config, path), *group);
  const ocio::ColorSpaceTransformRcPtr transform = ocio::ColorSpaceTransform::Create();
  transform->setSrc(entry_space(config, path).name);
  transform->setDst(space.c_str());
  group->appendTransform(transform);
  return group;
}

ocio::GroupTransformRcPtr inverted(ocio::GroupTransformRcPtr group) {
  group->setDirection(ocio::TRANSFORM_DIR_INVERSE);
  return group;
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

bool is_no_number(const float* rgb) { return std::isnan(rgb[0]) || std::isnan(rgb[1]) || std::isnan(rgb[2]); }
bool is_not_finite(const float* rgb) {
  return !std::isfinite(rgb[0]) || !std::isfinite(rgb[1]) || !std::isfinite(rgb[2]);
}

// Up to these no transform that is of use leaves what floats hold: from linear ones, from logarithmic ones, and of
// those from linear to linear.
constexpr float kCommonLight = 1e6F, kCommonCode = 1, kAny = std::numeric_limits<float>::max();

// As apply(). Error where colours up to `common` become what they may not.
void apply_to_frame(const ocio::CPUProcessor& processor, const std::filesystem::path& path, float common,
                    bool (*may_not)(const float*), std::vector<float>& rgb) {
  const auto is_common = [&](std::size_t i) {
    return std::abs(rgb[i]) <= common && std::abs(rgb[i + 1]) <= common && std::abs(rgb[i + 2]) <= common;
  };
  std::vector<bool> checked(rgb.size() / 3);
  for (std::size_t i = 0; i < checked.size(); ++i) checked[i] = is_common(3 * i);
  apply(processor, rgb);
  for (std::size_t i = 0; i < checked.size(); ++i) {
    if (!checked[i] || !may_not(&rgb[3 * i])) continue;
    throw Error({path.string(), "", "makes colours that are not finite of those that are", "a transform that works"});
  }
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

// Red, green and blue, and black, greys and colours from dim to as bright as frames hold.
std::vector<float> colors_to_probe() {
  std::vector<float> rgb{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  for (const float gain : {1e-3F, 0.1F, 1.0F, 30.0F, 6e4F}) {
    for (const Vec3f color : {Vec3f{1, 1, 1}, {1, 0.1F, 0.02F}, {0.3F, 1, 0}, {0, 0.2F, 1}, {0.5F, 0, 0.5F}}) {
      for (int c = 0; c < 3; ++c) rgb.push_back(gain * color[c]);
    }
  }
  return rgb;
}

// f(0) = 0, f(a + b) = f(a) + f(b) and f(k a) = k f(a): each |f(r, g, b) − (r f(red) + g f(green) + b f(blue))| ≤
// (1e-3 max(r, g, b) + 1e-6) max |f(primary)|.
bool is_linear(const ocio::CPUProcessor& processor) {
  const std::vector<float> from = colors_to_probe();
  std::vector<float> to = from;
  apply(processor, to);
  const auto [least, most] = std::minmax_element(to.begin(), to.begin() + 9);
  const float largest = std::max(-*least, *most);
  for (std::size_t i = 9; i < to.size(); ++i) {
    const float* color = &from[i / 3 * 3];
    const float sum = color[0] * to[i % 3] + color[1] * to[3 + i % 3] + color[2] * to[6 + i % 3];
    const float brightest = std::max({color[0], color[1], color[2]});
    if (!(std::abs(to[i] - sum) <= (1e-3F * brightest + 1e-6F) * largest)) return false;
  }
  return true;
}

bool is_linear_space(const ocio::ConstConfigRcPtr& config, const std::filesystem::path& path,
                     const std::string& space) {
  return is_linear(*cpu_processor(config, space_transform(config, path, space), path));
}

// Without those that cannot be converted to.
std::vector<std::string> linear_spaces(const ocio::ConstConfigRcPtr& config, const std::filesystem::path& path) {
  std::vector<std::string> spaces = color_spaces(config);
  std::erase_if(spaces, [&](const std::string& space) {
    try {
      return !is_linear_space(config, path, space);
    } catch (const Error&) {
      return true;
    }
  });
  return spaces;
}

Image rgb_of(const Image& image) {
  if (image.channel_count() >= 3) return {image.width, image.height, {"R", "G", "B"}, gather(image, {0, 1, 2})};
  throw Error({"image", "", fmt::format("has {} channels", image.channel_count()), "at least R, G, B"});
}

// Greys go there and back: each |forward(inverse(grey)) − grey| ≤ 0.02.
bool inverts(const ocio::CPUProcessor& inverse, const ocio::CPUProcessor& forward) {
  std::vector<float> greys;
  for (const float grey : {0.2F, 0.4F, 0.6F, 0.8F}) greys.insert(greys.end(), 3, grey);
  std::vector<float> again = greys;
  apply(inverse, again);
  apply(forward, again);
  return std::equal(again.begin(), again.end(), greys.begin(),
                    [](float a, float b) { return std::abs(a - b) <= 0.02F; });
}

ocio::ConstCPUProcessorRcPtr inverse_view_processor(const ocio::ConstConfigRcPtr& config,
                                                    const std::filesystem::path& path, const ViewOptions& options) {
  const auto forward = cpu_processor(config, view_transform(config, path, options), path);
  ocio::ConstCPUProcessorRcPtr inverse;
  try {
    inverse = config->getProcessor(inverted(view_transform(config, path, options)))->getDefaultCPUProcessor();
  } catch (const ocio::Exception&) {
  }
  if (inverse && inverts(*inverse, *forward)) return inverse;
  const std::string view = options.view.empty() ? "the default view" : fmt::format("view \"{}\"", options.view);
  throw Error({path.string(), "", view + " has no inverse", "a view that can be undone, or a colour space"});
}

// Beyond it the matrices and curves of a view may overflow, and what is brightest would be shown as black.
constexpr float kWhiteInAnyView = 1e15F;

float display_value(float value) { return std::isnan(value) ? 0 : std::clamp(value, 0.0F, 1.0F); }

}  // namespace

Image apply_display_view(const Image& image, const std::filesystem::path& config, const ViewOptions& options) {
  Image shown = rgb_of(image);
  const ocio::ConstConfigRcPtr loaded = load_config(config);
  const auto processor = cpu_processor(loaded, view_transform(loaded, config, options), config);
  const double gain = std::exp2(double(options.exposure));  // may be more than a float holds
  for (float& value : shown.pixels) {
    value = float(std::clamp(double(value) * gain, -double(kWhiteInAnyView), double(kWhiteInAnyView)));
  }
  apply_to_frame(*processor, config, kCommonLight, is_no_number, shown.pixels);
  std::transform(shown.pixels.begin(), shown.pixels.end(), shown.pixels.begin(), display_value);
  return shown;
}

Image to_rec709_from_display_view(const Image& image, const std::filesystem::path& config, const ViewOptions& options) {
  std::vector<float> rgb = rgb_of(image).pixels;
  const auto processor = inverse_view_processor(load_config(config), config, options);
  apply_to_frame(*processor, config, kCommonCode, is_not_finite, rgb);
  const float gain = std::exp2(-options.exposure);
  for (float& value : rgb) value *= gain;
  Image linear = image;
  scatter(rgb, {0, 1, 2}, linear);
  return linear;
}

void convert_from_rec709(Image& image, const std::filesystem::path& config, const std::string& space,
                         const std::vector<std::string>& color_layers) {
  const ocio::ConstConfigRcPtr loaded = load_config(config);
  check_space(loaded, space, config);
  const auto processor = cpu_processor(loaded, space_transform(loaded, config, space), config);
  for (const Triple& triple : color_triples(image, color_layers)) {
    std::vector<float> rgb = gather(image, triple);
    apply_to_frame(*processor, config, kAny, is_not_finite, rgb);
    scatter(rgb, triple, image);
  }
}

void require_linear_space(const std::filesystem::path& config, const std::string& space) {
  const ocio::ConstConfigRcPtr loaded = load_config(config);
  check_space(loaded, space, config);
  if (is_linear_space(loaded, config, space)) return;
  throw Error({config.string(), "colour space", fmt::format("\"{}\" is not scene-linear", space),
               fmt::format("one of {}", fmt::join(linear_spaces(loaded, config), ", "))});
}

std::string name_of_space(const std::filesystem::path& config, const std::string& space) {
  const ocio::ConstConfigRcPtr loaded = load_config(config);
  check_space(loaded, space, config);
  const ocio::ConstColorSpaceRcPtr found = loaded->getColorSpace(space.c_str());
  return found ? found->getName() : space;  // a named transform has no space
}

void convert_to_rec709(Image& image, const std::filesystem::path& config, const std::string& space) {
  std::vector<float> rgb = rgb_of(image).pixels;
  const ocio::ConstConfigRcPtr loaded = load_config(config);
  check_space(loaded, space, config);
  const auto processor = cpu_processor(loaded, inverted(space_transform(loaded, config, space)), config);
  apply_to_frame(*processor, config, kCommonCode, is_not_finite, rgb);
  scatter(rgb, {0, 1, 2}, image);
}

std::optional<std::array<float, 8>> chromaticities_of(const std::filesystem::path& config, const std::string& space) {
  const ocio::ConstConfigRcPtr loaded = load_config(config);
  check_space(loaded, space, config);
  const auto processor = cpu_processor(loaded, inverted(space_transform(loaded, config, space)), config);
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

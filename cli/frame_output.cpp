#include "cli/frame_output.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/add_options.h"
#include "cli/usage_error.h"
#include "renderer/core/counted.h"
#include "renderer/image/scene_linear.h"

namespace chiaro::cli {
namespace {

using renderer::Image;

constexpr CountRange kSideRange{1, 1 << 16};

bool parse_filter(const std::string& text) {
  if (text == "box") return true;
  if (text == "blackman-harris") return false;
  throw UsageError(fmt::format("'{}' (expected blackman-harris or box)", text));
}

// Layers that are not colours: geometry, identifiers, and the square of a colour.
bool is_color_layer(const std::string& layer) {
  return layer != "normal" && layer != "position" && layer != "depth" && layer != "variance" &&
         !layer.starts_with("Crypto");
}

// Halves keep neither identifiers nor large numbers of samples, nor metres to the millimetre, nor small variances.
bool needs_float(const std::string& channel) {
  return channel.starts_with("Crypto") || channel.starts_with("samples.") || channel.starts_with("variance.") ||
         channel.starts_with("depth.") || channel.starts_with("position.");
}

renderer::ChannelTypes channel_types(const Image& frame, bool full_float) {
  renderer::ChannelTypes types;
  for (const std::string& name : frame.channel_names) {
    types.push_back(full_float || needs_float(name) ? renderer::PixelType::kFloat : renderer::PixelType::kHalf);
  }
  return types;
}

void convert_to_output_space(Image& image, const FrameOptions& options) {
  const auto config = renderer::find_ocio_config(options.view.config);
  renderer::convert_from_rec709(image, config, options.output_space, color_layers(image));
}

// Without the attribute readers would take the primaries for Rec.709's, so a space that has none says its name instead.
void add_chromaticities(renderer::Attributes& attributes, const FrameOptions& options) {
  if (options.output_space.empty()) {
    attributes.emplace_back("chromaticities", kRec709Chromaticities);
    return;
  }
  const auto config = renderer::find_ocio_config(options.view.config);
  attributes.emplace_back(renderer::kColorSpaceAttribute, renderer::name_of_space(config, options.output_space));
  if (const auto known = renderer::chromaticities_of(config, options.output_space)) {
    attributes.emplace_back("chromaticities", *known);
  }
}

std::optional<renderer::EnvironmentLight> environment_among(const renderer::Lights& lights) {
  const auto found = std::find_if(lights.begin(), lights.end(), renderer::is_environment);
  if (found == lights.end()) return std::nullopt;
  return std::get<renderer::EnvironmentLight>(*found);
}

// What decides how good the frame is, and the lens.
void add_attributes(renderer::Attributes& attributes, const renderer::Frame& frame, const FrameOptions& options) {
  attributes.emplace_back("chiaro:samples", frame.samples);
  attributes.emplace_back("chiaro:mean_samples", float(frame.mean_samples));
  if (frame.relative_standard_error) {
    attributes.emplace_back("chiaro:relative_standard_error", float(*frame.relative_standard_error));
  }
  if (options.time_limit > 0) attributes.emplace_back("chiaro:time_limit", float(options.time_limit));
  if (options.noise_threshold > 0) attributes.emplace_back("chiaro:noise_threshold", float(options.noise_threshold));
  if (options.clamp_direct) attributes.emplace_back("chiaro:clamp_direct", *options.clamp_direct);
  if (options.clamp_indirect) attributes.emplace_back("chiaro:clamp_indirect", *options.clamp_indirect);
  if (options.wide_highlights) attributes.emplace_back("chiaro:wide_highlights", 1);
  if (options.box_filter) attributes.emplace_back("chiaro:filter", std::string("box"));
  if (frame.dropped_samples > 0) attributes.emplace_back("chiaro:dropped_samples", float(frame.dropped_samples));
  if (frame.interrupted) attributes.emplace_back("chiaro:interrupted", 1);
  if (options.lens.f_number) {
    attributes.emplace_back("aperture", *options.lens.f_number);
    attributes.emplace_back("chiaro:sensor_height", options.lens.sensor_height);
    attributes.emplace_back("chiaro:blades", options.lens.blades);
    if (options.lens.focal_length) attributes.emplace_back("chiaro:focal_length", *options.lens.focal_length);
  }
  if (frame.lens.radius > 0) attributes.emplace_back("focus", frame.lens.focus_distance);
  if (options.lens.shutter) {
    attributes.emplace_back("expTime", *options.lens.shutter);
    attributes.emplace_back("isoSpeed", options.lens.iso);
  }
}

bool is_too_dim(const Image& image, const renderer::ChannelTypes& types) {
  constexpr float kLeastNormalHalf = 6.103515625e-5F;
  float brightest = 0;
  for (const char* const name : {"R", "G", "B"}) {
    const int c = image.find_channel(name);
    if (c < 0 || types[std::size_t(c)] != renderer::PixelType::kHalf) return false;
    for (std::size_t i = std::size_t(c); i < image.pixels.size(); i += image.channel_names.size()) {
      brightest = std::max(brightest, image.pixels[i]);
    }
  }
  return brightest > 0 && brightest < kLeastNormalHalf;
}

HalfLosses losses_of(const Image& image, const renderer::ChannelTypes& types) {
  return {renderer::pixels_beyond_half(image, types), is_too_dim(image, types)};
}

}  // namespace

void add_frame_options(CLI::App& command, FrameOptions& options, const std::string& samples) {
  add_count(command, {"--width", "W", "Pixels across (default 960)"}, options.size.width, kSideRange);
  add_count(command, {"--height", "H", "Pixels down (default: from the camera's aspect ratio)"}, options.size.height,
            kSideRange);
  add_parsed(command,
             {"--layers", "a,b|all", "Further layers: " + fmt::format("{}", fmt::join(renderer::frame_layers(), ", "))},
             [&options](const std::string& text) { options.layers = parse_words(text, renderer::frame_layers()); });
  add_flag(command, "--float", options.full_float, "32-bit floats instead of 16-bit ones, which end at 65504");
  add_parsed(command, {"--filter", "NAME", "blackman-harris or box (default blackman-harris)"},
             [&options](const std::string& text) { options.box_filter = parse_filter(text); });
  add_number(command,
             {"--noise-threshold", "E",
              "Sample until every 8 x 8 pixels' standard error is E of their mean, or of a tenth of the frame's median "
              "where that is more; " +
                  samples + " is then the most"},
             options.noise_threshold, kPositiveFloat);
  add_number(command,
             {"--clamp-direct", "L",
              "Most cd/m² that one ray to a light, or one that meets it, adds to a sample; biased (default: none)"},
             options.clamp_direct, kPositive);
  add_number(command, {"--clamp-indirect", "L", "The same after each bounce"}, options.clamp_indirect, kPositive);
  add_flag(command, "--wide-highlights", options.wide_highlights,
           "Mirrors show point lights as lamps of a centimetre, and throw blurred caustics: less noise, but biased");
  add_lens_options(command, options.lens);
  add_text(command, {"--output-space", "NAME", "Scene-linear colour space of the EXR (default: Rec.709)"},
           options.output_space);
  add_view_options(command, options.view);
}

void require_color_choices(const FrameOptions& options, bool preview) {
  if (options.view.auto_exposure && options.lens.shutter) {
    throw UsageError("--exposure auto: --shutter exposes display pictures too (expected one of them)");
  }
  if (preview) require_view(options.view);
  if (options.output_space.empty()) return;
  renderer::require_linear_space(renderer::find_ocio_config(options.view.config), options.output_space);
}

std::vector<std::string> idle_frame_options(const CLI::App& command, std::optional<int> bounces) {
  if (bounces != 0) return {};
  return given_for_nothing(command, {"--clamp-indirect"}, "with --bounces 0");
}

void require_frame(const renderer::Camera& camera, const FrameOptions& options) {
  frame_size(camera, options.size);
  require_lens(options.lens, camera);
}

renderer::Frame render_frame(const renderer::RayTracer& tracer, const renderer::Camera& camera,
                             const renderer::Lights& lights, const FrameOptions& options, const FrameRun& run) {
  const std::array<int, 2> size = frame_size(camera, options.size);
  renderer::TraceOptions trace = run.trace;
  trace.wide_highlights = options.wide_highlights;
  const renderer::RenderOptions render_options{.width = size[0],
                                               .height = size[1],
                                               .trace = trace,
                                               .time_limit = options.time_limit,
                                               .noise_threshold = options.noise_threshold,
                                               .clamp_direct = options.clamp_direct.value_or(renderer::kInfinity),
                                               .clamp_indirect = options.clamp_indirect.value_or(renderer::kInfinity),
                                               .box_filter = options.box_filter,
                                               .lens = lens_of(options.lens, camera, tracer),
                                               .layers = options.layers};
  return renderer::render(tracer, camera, lights, render_options, run.control);
}

std::vector<std::string> color_layers(const Image& frame) {
  std::vector<std::string> layers;
  for (const std::string& name : frame.channel_names) {
    if (name == "R") layers.emplace_back();
    if (!name.ends_with(".R")) continue;
    const std::string layer = name.substr(0, name.size() - 2);
    if (is_color_layer(layer)) layers.push_back(layer);
  }
  return layers;
}

FrameOrigin frame_origin(const LitScene& scene, const TransportOptions& transport, const CommonOptions& common) {
  const auto name = [](const std::string& file) { return std::filesystem::path(file).filename().string(); };
  return {.scene = name(scene.file),
          .materials = text_of_materials(transport.materials),
          .seed = common.seed,
          .bounces = transport.bounces.value_or(-1),
          .hide_backs = transport.materials.hide_backs,
          .light_file = name(scene.light_file),
          .variant = transport.load.variant,
          .animation = transport.load.animation,
          .environment = environment_among(scene.lights)};
}

HalfLosses save_frame(const renderer::Frame& frame, const renderer::Camera& camera, const std::filesystem::path& path,
                      const FrameOrigin& origin, const FrameOptions& options) {
  const double aspect_ratio = double(frame.image.width) / frame.image.height;
  renderer::Attributes attributes = frame_attributes(camera, aspect_ratio, origin);
  add_attributes(attributes, frame, options);
  add_matte_attributes(attributes, frame.mattes);
  add_chromaticities(attributes, options);
  const renderer::ChannelTypes type = channel_types(frame.image, options.full_float);
  if (options.output_space.empty()) {
    renderer::save_image(frame.image, path, type, attributes);
    return losses_of(frame.image, type);
  }
  Image converted = frame.image;
  convert_to_output_space(converted, options);
  renderer::save_image(converted, path, type, attributes);
  return losses_of(converted, type);
}

void warn_of_frame(const renderer::Frame& frame, const HalfLosses& lost, const std::string& name, Session& session) {
  if (frame.dropped_samples > 0) {
    session.warn(fmt::format(
        "{}: {} left black", name,
        renderer::counted(frame.dropped_samples, "sample was not finite and is", "samples were not finite and are")));
  }
  if (const std::size_t held = lost.held; held > 0) {
    session.warn(fmt::format("{}: {} held at 65504 (--float keeps {})", name,
                             renderer::counted(held, "pixel is brighter than half floats hold, and is",
                                               "pixels are brighter than half floats hold, and are"),
                             held == 1 ? "it" : "them"));
  }
  if (lost.too_dim)
    session.warn(fmt::format("{}: is too dim for half floats, which round it (--float keeps it)", name));
}

void save_preview(const Image& frame, const std::filesystem::path& path, const FrameOptions& options) {
  ViewChoice view = options.view;
  view.view.exposure += camera_exposure(options.lens);
  renderer::save_image(displayed(frame, view), path, renderer::PixelType::kUint8);
}

JsonObject frame_summary(const renderer::Frame& frame, const std::string& camera) {
  return {{"camera", camera},
          {"width", frame.image.width},
          {"height", frame.image.height},
          {"channels", json_list(frame.image.channel_names)},
          {"samples", frame.samples},
          {"mean_samples", frame.mean_samples},
          {"relative_standard_error", frame.relative_standard_error},
          {"dropped_samples", std::int64_t(frame.dropped_samples)},
          {"interrupted", frame.interrupted},
          {"seconds", frame.seconds}};
}

}  // namespace chiaro::cli

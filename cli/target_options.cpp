#include "cli/target_options.h"

#include <algorithm>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/add_options.h"
#include "cli/camera_choice.h"
#include "cli/target_lightmap.h"
#include "cli/text_output.h"
#include "cli/usage_error.h"
#include "inverse/target/target_from_values.h"
#include "renderer/core/counted.h"
#include "renderer/core/error.h"

namespace chiaro::cli {
namespace {

using inverse::PixelCounts;
using renderer::Error;

constexpr double kOtherAspect = 0.01;      // of width to height, relative, or more
constexpr double kMuchIsWhite = 0.1;       // of the pixels, or more
constexpr double kHardlyAnyIsUsed = 0.02;  // of the pixels, or less

NamedFile parse_named_file(const std::string& text) {
  NamedFile named = split_named_file(text);
  if (named.file.empty()) throw UsageError(fmt::format("'{}' (expected NAME=FILE)", text));
  return named;
}

inverse::PictureContent parse_content(const std::string& text) {
  if (text == "beauty") return inverse::PictureContent::kBeauty;
  if (text == "illumination") return inverse::PictureContent::kIllumination;
  throw UsageError(fmt::format("'{}' (expected beauty or illumination)", text));
}

void add_picture_options(CLI::App& command, TargetChoices& choices) {
  naming_inputs(add_repeated(
      command,
      {"--target-image", "CAMERA=IMAGE",
       "A picture painted over a frame of that camera (without CAMERA=, the first); again for a further one"},
      [&choices](const std::string& text) { choices.images.push_back(parse_named_file(text)); }));
  naming_inputs(add_repeated(
      command, {"--mask", "CAMERA=IMAGE", "How much each pixel of that camera's picture counts: white 1, black 0"},
      [&choices](const std::string& text) { choices.masks.push_back(parse_named_file(text)); }));
  add_parsed(command,
             {"--image-content", "NAME",
              "beauty: the surfaces' colours are in the pictures and divided out; or illumination (default beauty)"},
             [&choices](const std::string& text) { choices.content = parse_content(text); });
  add_text(command,
           {"--image-space", "NAME",
            "Colour space of the pictures, of the OpenColorIO config (default: EXR, HDR and other floats are "
            "scene-linear, whole numbers what --display and --view show)"},
           choices.encoding.space);
  add_flag(command, "--keep-white", choices.encoding.keep_white,
           "White pixels of PNG, TIFF and JPEG pictures mean that white; else they may be brighter, and are left out");
}

NamedFile parse_lightmap(const std::string& text) {
  NamedFile named = parse_named_file(text);
  if (named.name.empty()) throw UsageError(fmt::format("'{}' (expected NODE=IMAGE)", text));
  return named;
}

void add_lightmap_options(CLI::App& command, TargetChoices& choices) {
  naming_inputs(add_repeated(
      command,
      {"--target-lightmap", "NODE=IMAGE",
       "Illumination of that node's surface, laid out by its texture coordinates; again for a further one"},
      [&choices](const std::string& text) { choices.lightmaps.push_back(parse_lightmap(text)); }));
  add_count(command,
            {"--lightmap-uv", "N", "Lightmaps are laid out by TEXCOORD_N (default 1, or 0 where a mesh has no other)"},
            choices.lightmap_uv, {0, renderer::kUvSetCount - 1});
}

std::string shown(const NamedFile& named) { return named.name.empty() ? "the first camera" : named.name; }

void require_masks_of_pictures(const TargetChoices& choices) {
  for (const NamedFile& mask : choices.masks) {
    const auto same = [&](const NamedFile& image) { return image.name == mask.name; };
    if (std::any_of(choices.images.begin(), choices.images.end(), same)) continue;
    throw UsageError(fmt::format("--mask: there is no --target-image of {}", shown(mask)));
  }
}

void apply_masks(const TargetChoices& choices, const NamedFile& image, PaintedPicture& picture) {
  for (const NamedFile& mask : choices.masks) {
    if (mask.name != image.name) continue;
    const std::vector<float> weight = load_mask(mask.file, picture.width, picture.height);
    for (std::size_t i = 0; i < weight.size(); ++i) picture.weight[i] *= weight[i];
  }
}

void warn_of_picture(const NamedFile& image, const PaintedPicture& picture, const renderer::Camera& camera,
                     Session& session) {
  const double aspect = double(picture.width) / picture.height;
  if (camera.aspect_ratio > 0 && std::abs(aspect / double(camera.aspect_ratio) - 1) > kOtherAspect) {
    session.warn(
        fmt::format("{}: is {} x {}, but camera '{}' has an aspect ratio of {:.3g}: its height is taken to show "
                    "what the camera's does",
                    image.file, picture.width, picture.height, camera.name, camera.aspect_ratio));
  }
  if (double(picture.white_pixels) >= kMuchIsWhite * double(picture.weight.size())) {
    session.warn(fmt::format("{}: {} of {} pixels are white, which may stand for anything brighter", image.file,
                             picture.white_pixels, picture.weight.size()));
  }
}

void require_some_used(const NamedFile& image, const PixelCounts& counts) {
  if (counts.used > 0) return;
  throw Error({image.file, "",
               fmt::format("no pixel tells an illumination ({} masked, {} without a surface, {} on edges, {} shiny or "
                           "shining, {} too dark, {} not finite or negative)",
                           counts.masked, counts.background, counts.edge, counts.shiny, counts.dark, counts.invalid),
               "matt surfaces"});
}

void warn_of_counts(const NamedFile& image, const PixelCounts& counts, std::size_t pixels, Session& session) {
  if (counts.invalid > 0) {
    session.warn(fmt::format("{}: {} not finite or negative, and left out", image.file,
                             renderer::counted(counts.invalid, "pixel is", "pixels are")));
  }
  if (double(counts.used) <= kHardlyAnyIsUsed * double(pixels)) {
    session.warn(fmt::format("{}: only {} of {} pixels tell an illumination", image.file, counts.used, pixels));
  }
}

JsonObject picture_summary(const NamedFile& image, const renderer::Camera& camera, const PaintedPicture& picture,
                           const PixelCounts& counts) {
  return {{"camera", camera.name},
          {"file", image.file},
          {"encoding", picture.encoding},
          {"white", picture.white},
          {"pixels", std::int64_t(picture.pixels.size())},
          {"used", std::int64_t(counts.used)},
          {"masked", std::int64_t(counts.masked)},
          {"white_pixels", std::int64_t(picture.white_pixels)},
          {"background", std::int64_t(counts.background)},
          {"edge", std::int64_t(counts.edge)},
          {"shiny", std::int64_t(counts.shiny)},
          {"dark", std::int64_t(counts.dark)},
          {"invalid", std::int64_t(counts.invalid)}};
}

std::string picture_text(const NamedFile& image, const renderer::Camera& camera, const PaintedPicture& picture,
                         const PixelCounts& counts) {
  return aligned_rows({{fmt::format("{} of {}", image.file, camera.name),
                        fmt::format("{}, white is {} cd/m², {} of {} pixels used", picture.encoding,
                                    text_of_vector(picture.white), counts.used, picture.pixels.size())}});
}

class TargetLoading {
 public:
  TargetLoading(const LoadedStage& stage, const TargetChoices& choices, Session& session)
      : stage_(stage), choices_(choices), session_(session) {}

  WantedTarget load() {
    for (const NamedFile& image : choices_.images) read_picture(image);
    if (!images_.empty()) wanted_.pictures.emplace_back("target_images", images_);
    if (!choices_.lightmaps.empty()) read_lightmaps();
    if (values_.empty()) {
      wanted_.target = from_file();
      return std::move(wanted_);
    }
    if (choices_.file.empty()) {
      wanted_.target = from_values(choose_receivers(*stage_.tracer, choices_.surface, session_));
    } else {
      const inverse::Target painted = from_file();
      wanted_.target = inverse::combine(painted, from_values(painted.receivers));
    }
    return std::move(wanted_);
  }

 private:
  inverse::Target from_file() const { return load_target_on(stage_, choices_.file, choices_.scale, session_); }

  void read_picture(const NamedFile& image) {
    PaintedPicture picture = load_painted_picture(image.file, choices_.encoding);
    const renderer::Camera camera = choose_camera(*stage_.scene, image.name, {picture.width, picture.height}, session_);
    apply_masks(choices_, image, picture);
    warn_of_picture(image, picture, camera, session_);
    inverse::FrameValues read = inverse::values_of_frame(
        *stage_.tracer, {camera, picture.width, picture.height, picture.pixels, picture.weight, choices_.content},
        session_.control());
    require_some_used(image, read.counts);
    warn_of_counts(image, read.counts, picture.pixels.size(), session_);
    images_.emplace_back(picture_summary(image, camera, picture, read.counts));
    wanted_.text += picture_text(image, camera, picture, read.counts);
    const std::size_t first = values_.size();
    add(std::move(read.values));
    scale_weights(first, 1 / double(picture.pixels.size()));  // pictures count alike, whatever their resolution
  }

  // Together they count as one picture: a node that they cover by its area.
  void read_lightmaps() {
    const std::size_t first = values_.size();
    JsonList summaries;
    double area = 0;
    for (const NamedFile& named : choices_.lightmaps) {
      TargetLightmap read = load_target_lightmap(*stage_.scene, {named.name, named.file, choices_.lightmap_uv},
                                                 choices_.encoding, session_);
      add(std::move(read.values.values));
      area += read.values.area;
      summaries.emplace_back(read.summary);
      wanted_.text += read.text;
    }
    wanted_.pictures.emplace_back("target_lightmaps", summaries);
    scale_weights(first, 1 / area);
  }

  void add(std::vector<inverse::SurfaceValue> values) {
    if (values_.empty()) {
      values_ = std::move(values);
    } else {
      values_.insert(values_.end(), values.begin(), values.end());
    }
  }

  void scale_weights(std::size_t first, double scale) {
    for (std::size_t i = first; i < values_.size(); ++i) values_[i].weight = float(double(values_[i].weight) * scale);
  }

  inverse::Target from_values(const inverse::Receivers& receivers) const {
    inverse::TargetFromValues result = inverse::target_from_values(receivers, values_, session_.control());
    if (result.not_placed > 0) {
      session_.warn(fmt::format("{} of {} painted values lie on surfaces without receivers, and are left out",
                                result.not_placed, values_.size()));
    }
    if (wants_light(result.target)) return std::move(result.target);
    const NamedFile& first = choices_.images.empty() ? choices_.lightmaps.front() : choices_.images.front();
    throw Error({first.file, "", "an empty target: black, or all but, or of surfaces without receivers",
                 fmt::format("illumination of {:g} cd/m² or more somewhere", inverse::kDimmest)});
  }

  const LoadedStage& stage_;
  const TargetChoices& choices_;
  Session& session_;
  std::vector<inverse::SurfaceValue> values_;
  JsonList images_;
  WantedTarget wanted_;
};

inverse::Target on_scene(inverse::Target target, const LoadedStage& stage, const std::string& file, float scale,
                         Session& session) {
  place_on_scene(*stage.tracer, target.receivers, file, session);
  session.warn(target.warnings);
  if (scale != 1 && !target.has_scaled_colors) {
    session.warn(fmt::format("--target-scale: does nothing with {}, whose _ILLUMINATION is in cd/m²", file));
  }
  return target;
}

}  // namespace

void add_target_options(CLI::App& command, TargetChoices& choices) {
  add_input_file(command, {"--target", "T.glb", "The painted illumination"}, choices.file);
  add_target_scale_option(command, choices.scale);
  add_picture_options(command, choices);
  add_lightmap_options(command, choices);
  add_surface_options(command, choices.surface);
}

void require_a_target(const TargetChoices& choices) {
  const bool pictures = !choices.images.empty() || !choices.lightmaps.empty();
  if (choices.file.empty() && !pictures) {
    throw UsageError(
        "nothing is wanted (expected --target T.glb, --target-image CAMERA=IMAGE or --target-lightmap NODE=IMAGE)");
  }
  if (!choices.file.empty() && (!choices.surface.on.empty() || choices.surface.max_edge > 0)) {
    throw UsageError("--target has receivers of its own (expected neither --on nor --max-edge)");
  }
  if (choices.encoding.view.auto_exposure && pictures) {
    throw UsageError("--exposure: auto does not tell what a painted picture's white is (expected a number)");
  }
  require_masks_of_pictures(choices);
}

std::vector<std::string> idle_target_options(const CLI::App& command) {
  const std::vector<std::string> pictures{"--target-image", "--target-lightmap"};
  std::vector<std::string> warnings = idle_options(command, {"--image-space", "--keep-white"}, pictures);
  for (const auto& [option, needed] : {std::pair{"--lightmap-uv", "--target-lightmap"},
                                       {"--target-scale", "--target"},
                                       {"--image-content", "--target-image"}}) {
    const std::vector<std::string> idle = idle_options(command, {option}, {needed});
    warnings.insert(warnings.end(), idle.begin(), idle.end());
  }
  return warnings;
}

void add_target_scale_option(CLI::App& command, float& scale) {
  add_number(command, {"--target-scale", "S", "cd/m² of a vertex colour of 1 (default 1)"}, scale, kPositive);
}

inverse::Target load_target_on(const LoadedStage& stage, const std::string& file, float scale, Session& session) {
  return on_scene(inverse::load_target(file, scale), stage, file, scale, session);
}

inverse::Target load_illumination_on(const LoadedStage& stage, const std::string& file, float scale, Session& session) {
  return on_scene(inverse::load_illumination(file, scale), stage, file, scale, session);
}

bool is_target_file_alone(const TargetChoices& choices) { return choices.images.empty() && choices.lightmaps.empty(); }

WantedTarget load_wanted_target(const LoadedStage& stage, const TargetChoices& choices, Session& session) {
  return TargetLoading(stage, choices, session).load();
}

}  // namespace chiaro::cli

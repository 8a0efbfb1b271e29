#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/add_options.h"
#include "cli/commands.h"
#include "cli/comparison_summary.h"
#include "cli/error_context.h"
#include "cli/frame_comparison.h"
#include "cli/output_paths.h"
#include "cli/program.h"
#include "cli/session.h"
#include "cli/target_options.h"
#include "cli/text_output.h"
#include "cli/usage_error.h"
#include "renderer/core/counted.h"
#include "renderer/core/file_extension.h"
#include "renderer/image/image_file.h"

namespace chiaro::cli {
namespace {

constexpr NumberRange kPixelsPerDegreeRange{.min = 1, .max = 1000};

struct CompareCommand {
  const CLI::App* command = nullptr;
  CommonOptions common;
  std::string a, b, output;
  std::optional<double> fail_above, fail_above_flip;
  bool resize = false;
  float target_scale = 1;
  FrameComparisonOptions frames;
};

bool is_target(const std::string& file) { return renderer::has_extension(file, {".glb", ".gltf"}); }

// Of a file that is no target. Error where it is no picture either.
const char* kind_of(const std::string& file) {
  return renderer::load_image_header(file).image.find_channel("visibility") >= 0 ? "a transport cache" : "a frame";
}

int limit_exceeded(const std::string& what, const std::string& reason, double limit) {
  print_message(fmt::format("limit exceeded: {}: {} (at most {:g})", what, reason, limit));
  return kLimitExceeded;
}

// Written as inequalities that no NaN satisfies.
int verdict(const CompareCommand& options, const std::string& what, const FrameFigures& found) {
  const auto& [image, flip, flip_hdr] = found;
  if (image.not_finite > 0 && (options.fail_above || options.fail_above_flip)) {
    return limit_exceeded(what, renderer::counted(image.not_finite, "pixel is not finite", "pixels are not finite"), 0);
  }
  if (options.fail_above && !(image.relative_l2 <= *options.fail_above)) {
    return limit_exceeded(what, fmt::format("relative_l2 is {:.6g}", image.relative_l2), *options.fail_above);
  }
  if (options.fail_above_flip && !(flip <= *options.fail_above_flip)) {
    return limit_exceeded(what, fmt::format("flip is {:.6g}", flip.value_or(1)), *options.fail_above_flip);
  }
  return kDone;
}

// The regions', where there are any.
int verdict(const CompareCommand& options, const FrameComparison& comparison) {
  if (comparison.regions.empty()) return verdict(options, options.a, comparison.whole);
  int worst = kDone;
  for (std::size_t i = 0; i < comparison.regions.size(); ++i) {
    const std::string what = fmt::format("{}: {}", options.a, comparison.regions[i].name);
    worst = std::max(worst, verdict(options, what, comparison.of_regions[i]));
  }
  return worst;
}

void refuse_options_of_frames(const CompareCommand& options) {
  const auto refuse = [](const char* option) {
    throw UsageError(fmt::format("{}: two targets have no pixels (expected two frames)", option));
  };
  if (!options.output.empty()) throw UsageError("--output: two targets have no picture (expected two frames)");
  if (!options.frames.regions.empty()) refuse("--crop");
  if (options.fail_above_flip) refuse("--fail-above-flip");
  if (options.resize) refuse("--resize");
}

int compare_two_targets(const CompareCommand& options, Session& session) {
  refuse_options_of_frames(options);
  const inverse::Target a = inverse::load_illumination(options.a, options.target_scale);
  const inverse::Target b = inverse::load_illumination(options.b, options.target_scale);
  require_weight(b, options.b);
  session.warn(a.warnings);
  session.warn(b.warnings);
  if (!a.has_scaled_colors && !b.has_scaled_colors) {
    session.warn(given_for_nothing(*options.command, {"--target-scale"}, "with _ILLUMINATION, which is in cd/m²"));
  }
  session.warn(given_for_nothing(
      *options.command, {"--ocio", "--display", "--view", "--look", "--exposure", "--no-flip", "--pixels-per-degree"},
      "between two targets"));
  session.stop_if_interrupted();
  const inverse::TargetComparison comparison = naming_file(options.a, [&] { return inverse::compare_targets(a, b); });
  const renderer::Vec3f place = b.receivers.positions[comparison.max_at];
  session.finish(comparison_summary(comparison, place), comparison_text(comparison, place));
  if (!options.fail_above || comparison.relative_l2 <= *options.fail_above) return kDone;
  return limit_exceeded(options.a, fmt::format("relative_l2 is {:.6g}", comparison.relative_l2), *options.fail_above);
}

// Where limits are asked for, they are exceeded.
void require_something_finite(const CompareCommand& options, const ComparedFrames& frames,
                              const renderer::ImageComparison& found) {
  const std::size_t pixels = std::size_t(frames.a.width) * std::size_t(frames.a.height);
  if (found.not_finite < pixels || options.fail_above || options.fail_above_flip) return;
  throw renderer::Error(
      {options.a, "", fmt::format("no pixel is finite both there and in {}", options.b), "pictures without NaN"});
}

int compare_two_frames(const CompareCommand& options, Session& session) {
  session.require_outputs({options.output});
  session.warn(given_for_nothing(*options.command, {"--target-scale"}, "between two frames"));
  if (!options.output.empty()) require_view(options.frames.view);
  const ComparedFrames frames = load_compared_frames(options.a, options.b, options.frames.view, options.resize);
  session.stop_if_interrupted();
  FrameComparisonOptions wanted = options.frames;
  wanted.picture = !options.output.empty();
  const FrameComparison comparison =
      naming_file(options.a, [&] { return compare_frames(frames, wanted, session.control()); });
  session.warn(frames.notes);
  if (!frames.by_view) {
    session.warn(given_for_nothing(*options.command, {"--display", "--view", "--look", "--exposure"},
                                   "between two display pictures"));
  }
  require_something_finite(options, frames, comparison.whole.image);
  if (const std::size_t bad = comparison.whole.image.not_finite; bad > 0) {
    session.warn(renderer::counted(bad, "pixel is not finite and left out", "pixels are not finite and left out"));
  }
  if (!options.output.empty()) {
    renderer::save_image(renderer::comparison_picture(comparison.panels), options.output, renderer::PixelType::kUint8);
  }
  session.finish(comparison_summary(comparison), comparison_text(comparison));
  return verdict(options, comparison);
}

int run_compare(const CompareCommand& options) {
  if (options.frames.no_flip && options.fail_above_flip) {
    throw UsageError("--fail-above-flip: --no-flip leaves it out (expected one of them)");
  }
  Session session(options.common);
  if (is_target(options.a) != is_target(options.b)) {
    const std::string& target = is_target(options.a) ? options.a : options.b;
    const std::string& other = is_target(options.a) ? options.b : options.a;
    throw renderer::Error(
        {target, "", fmt::format("is a target, but {} is {}", other, kind_of(other)), "two frames or two targets"});
  }
  return is_target(options.a) ? compare_two_targets(options, session) : compare_two_frames(options, session);
}

}  // namespace

CommandRun add_compare(CLI::App& command) {
  const auto options = std::make_shared<CompareCommand>();
  options->command = &command;
  add_input(command, {"a", "A", "Frame or target"}, options->a);
  add_input(command, {"b", "B", "The reference"}, options->b);
  add_output(command, {"-o,--output", "DIFF.png", "A, B, 8 times their difference and FLIP, as the view shows them"},
             options->output, {".png"})
      ->required(false);
  add_number(command, {"--fail-above", "E", "Exit with 3 where relative_l2 exceeds E, or a pixel is not finite"},
             options->fail_above, kNotNegative);
  add_number(command, {"--fail-above-flip", "E", "The same of FLIP"}, options->fail_above_flip, kZeroToOne);
  add_repeated(
      command,
      {"--crop", "[NAME=]x0,y0,x1,y1",
       "Figures of these pixels too, up to before x1 and y1; limits then hold there; may be repeated"},
      [options = options.get()](const std::string& text) { options->frames.regions.push_back(parse_region(text)); });
  add_target_scale_option(command, options->target_scale);
  add_flag(command, "--resize", options->resize, "Resize A to the size of B where they differ");
  add_number(command, {"--pixels-per-degree", "P", "Of the viewer's field, for FLIP (default 67.02)"},
             options->frames.pixels_per_degree, kPixelsPerDegreeRange);
  add_flag(command, "--no-flip", options->frames.no_flip, "Leave out FLIP, which takes the time for large frames");
  add_view_options(command, options->frames.view);
  add_common_options(command, options->common);
  set_examples(command,
               "  chiaro compare frame.exr reference.exr -o difference.png --fail-above 0.02\n"
               "  chiaro compare frame.exr reference.exr --crop face=200,80,320,240 --fail-above-flip 0.05\n"
               "  chiaro compare found.glb painted.glb --json");
  return [options] { return run_compare(*options); };
}

}  // namespace chiaro::cli

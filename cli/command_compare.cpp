#include <cstdio>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/add_options.h"
#include "cli/commands.h"
#include "cli/comparison_summary.h"
#include "cli/difference_picture.h"
#include "cli/error_context.h"
#include "cli/output_paths.h"
#include "cli/program.h"
#include "cli/session.h"
#include "cli/usage_error.h"
#include "renderer/image/image_file.h"

namespace chiaro::cli {
namespace {

struct CompareCommand {
  CommonOptions common;
  std::string a, b, output;
  std::optional<double> fail_above;
  ViewChoice view;
};

bool is_target(const std::string& file) { return has_extension(file, {".glb", ".gltf"}); }

// Written as an inequality that no NaN satisfies.
int verdict(const CompareCommand& options, double relative_l2, std::size_t not_finite) {
  if (!options.fail_above || (relative_l2 <= *options.fail_above && not_finite == 0)) return kDone;
  const std::string reason = not_finite > 0 ? fmt::format("{} pixels are not finite", not_finite)
                                            : fmt::format("relative_l2 is {:.6g}", relative_l2);
  std::fprintf(stderr, "chiaro: limit exceeded: %s: %s (at most %g)\n", options.a.c_str(), reason.c_str(),
               *options.fail_above);
  return kLimitExceeded;
}

int compare_two_targets(const CompareCommand& options, Session& session) {
  if (!options.output.empty()) throw UsageError("--output: two targets have no picture (expected two frames)");
  const inverse::Target a = inverse::load_target(options.a);
  const inverse::Target b = inverse::load_target(options.b);
  session.stop_if_interrupted();
  const inverse::TargetComparison comparison = naming_file(options.a, [&] { return inverse::compare_targets(a, b); });
  const renderer::Vec3f place = b.receivers.positions[comparison.max_at];
  session.finish(comparison_summary(comparison, place), comparison_text(comparison, place));
  return verdict(options, comparison.relative_l2, 0);
}

int compare_two_frames(const CompareCommand& options, Session& session) {
  if (!options.output.empty()) {
    require_writable(options.output);
    require_view(options.view);
  }
  const renderer::Image a = renderer::load_image(options.a).image;
  const renderer::Image b = renderer::load_image(options.b).image;
  session.stop_if_interrupted();
  const bool linear = is_scene_linear(options.a);
  if (linear != is_scene_linear(options.b)) {
    session.warn(fmt::format("{} and {}: one is scene-linear, the other is not", options.a, options.b));
  }
  const renderer::ImageComparison comparison = naming_file(options.a, [&] { return renderer::compare_images(a, b); });
  if (comparison.not_finite > 0)
    session.warn(fmt::format("{} pixels are not finite and left out", comparison.not_finite));
  if (!options.output.empty()) {
    const renderer::Image picture =
        linear ? scene_linear_picture(a, b, options.view) : renderer::comparison_picture(a, b);
    renderer::save_image(picture, options.output, renderer::PixelType::kUint8);
  }
  session.finish(comparison_summary(comparison), comparison_text(comparison));
  return verdict(options, comparison.relative_l2, comparison.not_finite);
}

int run_compare(const CompareCommand& options) {
  Session session(options.common);
  if (is_target(options.a) != is_target(options.b)) {
    const std::string& target = is_target(options.a) ? options.a : options.b;
    const std::string& frame = is_target(options.a) ? options.b : options.a;
    throw renderer::Error(
        {target, "", fmt::format("is a target, but {} is a frame", frame), "two frames or two targets"});
  }
  return is_target(options.a) ? compare_two_targets(options, session) : compare_two_frames(options, session);
}

}  // namespace

CommandRun add_compare(CLI::App& command) {
  const auto options = std::make_shared<CompareCommand>();
  add_input(command, {"a", "A", "Frame or target"}, options->a);
  add_input(command, {"b", "B", "The reference"}, options->b);
  add_output(command, {"-o,--output", "DIFF.png", "A, B and 8 times their difference, as the view shows them"},
             options->output, {".png"})
      ->required(false);
  add_number(command, {"--fail-above", "E", "Exit with 3 where relative_l2 exceeds E, or a pixel is not finite"},
             options->fail_above, kNotNegative);
  add_view_options(command, options->view);
  add_common_options(command, options->common);
  set_examples(command,
               "  chiaro compare frame.exr reference.exr -o difference.png --fail-above 0.02\n"
               "  chiaro compare found.glb painted.glb --json");
  return [options] { return run_compare(*options); };
}

}  // namespace chiaro::cli

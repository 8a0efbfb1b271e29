#include "cli/view_options.h"

#include <cmath>

#include <fmt/format.h>

#include "cli/add_options.h"
#include "cli/usage_error.h"

namespace chiaro::cli {
namespace {

constexpr double kMiddleGrey = 0.18;
constexpr NumberRange kExposureRange{.min = -100, .max = 100};

void parse_exposure(const std::string& text, ViewChoice& choice) {
  choice.auto_exposure = text == "auto";
  try {
    choice.view.exposure = choice.auto_exposure ? 0 : float(parse_number(text, kExposureRange));
  } catch (const UsageError&) {
    throw UsageError(
        fmt::format("'{}' (expected auto, or a number from {} to {})", text, kExposureRange.min, kExposureRange.max));
  }
}

}  // namespace

void add_view_options(CLI::App& command, ViewChoice& choice, const OptionText& exposure) {
  naming_inputs(add_parsed(command, {"--ocio", "CONFIG", "OpenColorIO config (default: $OCIO, or the one installed)"},
                           [&choice](const std::string& text) {
                             if (text.empty()) throw UsageError("is empty (expected an OpenColorIO config)");
                             choice.config = text;
                           }));
  add_text(command, {"--display", "NAME", "Display of the config (default: its first)"}, choice.view.display);
  add_text(command, {"--view", "NAME", "View of the display (default: its first)"}, choice.view.view);
  add_text(command, {"--look", "NAME", "Look in place of the view's own, or none"}, choice.view.look);
  add_parsed(command, exposure, [&choice](const std::string& text) { parse_exposure(text, choice); });
}

std::vector<std::string> idle_view_options(const CLI::App& command, const std::vector<std::string>& shown_by,
                                           const std::vector<std::string>& converted_by) {
  std::vector<std::string> config_users = shown_by;
  config_users.insert(config_users.end(), converted_by.begin(), converted_by.end());
  std::vector<std::string> warnings = idle_options(command, {"--ocio"}, config_users);
  const auto views = idle_options(command, {"--display", "--view", "--look", "--exposure"}, shown_by);
  warnings.insert(warnings.end(), views.begin(), views.end());
  return warnings;
}

void require_view(const ViewChoice& choice) { displayed(renderer::make_image(1, 1, {"R", "G", "B"}), choice); }

renderer::Image displayed(const renderer::Image& image, const ViewChoice& choice) {
  return renderer::apply_display_view(image, renderer::find_ocio_config(choice.config),
                                      exposed_for(image, choice).view);
}

ViewChoice exposed_for(const renderer::Image& image, ViewChoice choice) {
  if (choice.auto_exposure) choice.view.exposure = auto_exposure(image);
  choice.auto_exposure = false;
  return choice;
}

float auto_exposure(const renderer::Image& image) {
  double sum = 0;
  std::size_t count = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float* pixel = image.at(x, y);
      const double luminance = renderer::luminance({pixel[0], pixel[1], pixel[2]});
      if (!std::isfinite(luminance) || luminance <= 0) continue;
      sum += std::log(luminance);
      ++count;
    }
  }
  return count == 0 ? 0 : float(std::log2(kMiddleGrey / std::exp(sum / double(count))));
}

}  // namespace chiaro::cli

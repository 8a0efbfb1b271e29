#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/add_options.h"
#include "renderer/core/vec.h"
#include "renderer/image/color_management.h"
#include "renderer/image/image.h"

namespace CLI {
class App;
}

namespace chiaro::cli {

// --ocio, --display, --view, --look, --exposure.
struct ViewChoice {
  std::optional<std::filesystem::path> config;
  renderer::ViewOptions view;
  bool auto_exposure = false;
};

void add_view_options(CLI::App& command, ViewChoice& choice,
                      const OptionText& exposure = {"--exposure", "EV|auto",
                                                    "Exposure of display pictures (default 0)"});

// A warning for each of them that was given and does nothing: none of `shown_by` was given, by which the view shows
// something, nor for --ocio one of `converted_by`, which need its colour spaces alone.
std::vector<std::string> idle_view_options(const CLI::App& command, const std::vector<std::string>& shown_by,
                                           const std::vector<std::string>& converted_by);

// Error where the config, the display or the view does not exist: asked before the long work starts.
void require_view(const ViewChoice& choice);

// The image (scene-linear Rec.709) as the view shows it.
renderer::Image displayed(const renderer::Image& image, const ViewChoice& choice);

// The choice with an automatic exposure made that of `image`.
ViewChoice exposed_for(const renderer::Image& image, ViewChoice choice);

// The EV that brings the log-average luminance of the pixels that are neither black nor infinite to 0.18; 0 where there
// are none.
float auto_exposure(const renderer::Image& image);

}  // namespace chiaro::cli

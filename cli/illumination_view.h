#pragma once
// Pictures of illumination: what was painted, as a camera sees it.

#include <string>

#include "cli/camera_choice.h"
#include "cli/transport_options.h"
#include "cli/view_options.h"
#include "inverse/target/target.h"

namespace chiaro::cli {

// An illumination picture (R, G, B, A) as the view shows it; grey hatching where the illumination is not known.
renderer::Image displayed_illumination(const renderer::Image& picture, const ViewChoice& view);

// Its colours alone, not multiplied by alpha.
renderer::Image colors_of(const renderer::Image& picture);

// |a − b| × 8 where both are known.
renderer::Image illumination_difference(const renderer::Image& a, const renderer::Image& b);

// --picture, --camera, --width, --height and the view options.
struct IlluminationPictureOptions {
  std::string file, camera;  // file empty: none is wanted
  FrameSize size;
  ViewChoice view;
};

void add_illumination_picture_options(CLI::App& command, IlluminationPictureOptions& options);

// Error or UsageError where there is no such kind of picture, or no such view: asked before the work.
void require_picture(const IlluminationPictureOptions& options);

// The target, on surfaces of the scene file, into the file: EXR holds cd/m² and alpha, others show them.
void save_illumination_picture(const IlluminationPictureOptions& options, const std::string& scene,
                               const TransportOptions& transport, const inverse::Target& target, Session& session);

}  // namespace chiaro::cli

#pragma once
// Pictures of illumination: what was painted, as a camera sees it.

#include <optional>
#include <string>

#include "cli/camera_choice.h"
#include "cli/view_options.h"
#include "renderer/image/image.h"

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

// What a picture is taken with.
struct PictureCamera {
  renderer::Camera camera;
  int width = 0, height = 0;
};

// Absent: no picture is wanted. Error where the scene has no such camera, UsageError where the picture would be too
// large: asked before the work, too.
std::optional<PictureCamera> choose_picture_camera(const IlluminationPictureOptions& options,
                                                   const renderer::Scene& scene, Session& session);

// An illumination picture into the file: EXR holds cd/m² and alpha, others show them.
void save_illumination_picture(const IlluminationPictureOptions& options, const renderer::Image& picture);

}  // namespace chiaro::cli

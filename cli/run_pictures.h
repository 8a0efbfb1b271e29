#pragma once

#include <filesystem>

#include "cli/frame_output.h"
#include "cli/run_page.h"

namespace chiaro::cli {

// What the pictures of a run show.
struct RunPictures {
  const renderer::RayTracer& tracer;
  const inverse::Target& target;
  const inverse::Target& found;
  const FrameOptions& options;
  std::filesystem::path folder;  // where they are written: CAMERA.target.png, .found.png, .difference.png, .frame.png
};

// The illumination that was wanted, that found and eight times their difference, and the frame, as one camera sees
// them; no wider than a page shows.
PageCamera make_page_camera(const RunPictures& run, const renderer::Camera& camera, const std::string& file_name,
                            const renderer::Image& frame, const renderer::Control& control);

// What they are called in the folder.
std::vector<std::string> run_picture_files(const std::string& file_name);

}  // namespace chiaro::cli

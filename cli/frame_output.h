#pragma once
// What `render` and `run` share: the options of a frame, and its files.

#include <filesystem>
#include <string>
#include <vector>

#include "cli/camera_choice.h"
#include "cli/frame_metadata.h"
#include "cli/json_output.h"
#include "cli/lens_options.h"
#include "cli/transport_options.h"
#include "cli/view_options.h"
#include "renderer/image/image_file.h"
#include "renderer/trace/render.h"

namespace chiaro::cli {

struct FrameOptions {
  FrameSize size;
  double time_limit = 0;                              // seconds; 0: none
  double noise_threshold = 0;                         // 0: none
  std::optional<float> clamp_direct, clamp_indirect;  // cd/m²
  bool wide_highlights = false;
  LensOptions lens;
  std::vector<std::string> layers;
  bool full_float = false;
  bool box_filter = false;
  std::string output_space;  // of the OpenColorIO config; empty: scene-linear Rec.709
  ViewChoice view;
};

// How a frame is traced, whatever it looks like.
struct FrameRun {
  renderer::TraceOptions trace;
  const renderer::Control& control;
};

// samples: the name of the option that says how many there are.
void add_frame_options(CLI::App& command, FrameOptions& options, const std::string& samples);

// UsageError where the camera cannot have a frame of that size, or a lens like that.
void require_frame(const renderer::Camera& camera, const FrameOptions& options);

// Error where the colour spaces, displays or views asked for do not exist, or the space is not linear. UsageError where
// two options expose the preview.
void require_color_choices(const FrameOptions& options, bool preview);

// Warnings of what was given and does nothing in frames of so many bounces.
std::vector<std::string> idle_frame_options(const CLI::App& command, std::optional<int> bounces);

// The frame as the options want it.
renderer::Frame render_frame(const renderer::RayTracer& tracer, const renderer::Camera& camera,
                             const renderer::Lights& lights, const FrameOptions& options, const FrameRun& run);

// Files of the scene and of its lights; empty: the scene's own. lights: all that shine.
struct LitScene {
  std::string file, light_file;
  const renderer::Lights& lights;
};

// What half floats do not hold of a frame.
struct HalfLosses {
  std::size_t held = 0;  // pixels, at the largest
  bool too_dim = false;  // its brightest colour is fewer steps of halves than they have of brighter ones
};

FrameOrigin frame_origin(const LitScene& scene, const TransportOptions& transport, const CommonOptions& common);

// What is to be said of a frame besides its figures.
void warn_of_frame(const renderer::Frame& frame, const HalfLosses& lost, const std::string& name, Session& session);

// Writes the frame as EXR with all of its attributes.
HalfLosses save_frame(const renderer::Frame& frame, const renderer::Camera& camera, const std::filesystem::path& path,
                      const FrameOrigin& origin, const FrameOptions& options);

// Writes the frame's colours as the view shows them (8 bits).
void save_preview(const renderer::Image& frame, const std::filesystem::path& path, const FrameOptions& options);

// The layers of a frame that are colours ("" = the beauty), as convert_from_rec709 wants them.
std::vector<std::string> color_layers(const renderer::Image& frame);

JsonObject frame_summary(const renderer::Frame& frame, const std::string& camera);

}  // namespace chiaro::cli

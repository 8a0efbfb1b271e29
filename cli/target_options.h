#pragma once
// What is wanted: a target file, painted pictures, lightmaps, or several of them together.

#include <optional>
#include <string>
#include <vector>

#include "cli/json_output.h"
#include "cli/named_file.h"
#include "cli/painted_picture.h"
#include "cli/scene_loading.h"
#include "cli/transport_options.h"
#include "inverse/target/painted_frame.h"
#include "inverse/target/target.h"

namespace chiaro::cli {

struct TargetChoices {
  std::string file;
  float scale = 1;                       // cd/m² per COLOR_0, where a target file has no _ILLUMINATION
  SurfaceOptions surface;                // where there is no target file
  std::vector<NamedFile> images, masks;  // of cameras; without a name, of the scene's first
  std::vector<NamedFile> lightmaps;      // of nodes
  std::optional<int> lightmap_uv;
  inverse::PictureContent content = inverse::PictureContent::kBeauty;
  PictureEncoding encoding;
};

// All but the view options, which belong to `choices.encoding.view`.
void add_target_options(CLI::App& command, TargetChoices& choices);

// UsageError where they contradict each other.
void require_a_target(const TargetChoices& choices);

// A warning for each option that was given and is of a kind of target that is not.
std::vector<std::string> idle_target_options(const CLI::App& command);

// Whether a target file is wanted as it is, and nothing else.
bool is_target_file_alone(const TargetChoices& choices);

struct WantedTarget {
  inverse::Target target;
  JsonObject pictures;  // "target_images" and "target_lightmaps": what was made of each; none where there are none
  std::string text;     // the same for people
};

// Error where a file is of another scene, or where the pictures show nothing that could be wanted.
WantedTarget load_wanted_target(const LoadedStage& stage, const TargetChoices& choices, Session& session);

void add_target_scale_option(CLI::App& command, float& scale);

// A target file, its samples placed on the scene. Warnings are passed on, and of a scale that does nothing with it.
inverse::Target load_target_on(const LoadedStage& stage, const std::string& file, float scale, Session& session);
// The same of one that may want no light.
inverse::Target load_illumination_on(const LoadedStage& stage, const std::string& file, float scale, Session& session);

}  // namespace chiaro::cli

#include <algorithm>
#include <initializer_list>
#include <memory>

#include <nlohmann/json.hpp>

#include "cli/add_options.h"
#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/inspect.h"
#include "cli/program.h"
#include "cli/scene_options.h"
#include "cli/session.h"
#include "renderer/core/atomic_file.h"
#include "renderer/core/file_extension.h"

namespace chiaro::cli {
namespace {

struct InspectCommand {
  CommonOptions common;
  std::string file;
  renderer::LoadOptions load;  // of a scene
  const CLI::App* command = nullptr;
};

bool mentions(const std::string& bytes, const char* text) { return bytes.find(text) != std::string::npos; }

bool mentions_any(const std::string& bytes, std::initializer_list<const char*> texts) {
  return std::any_of(texts.begin(), texts.end(), [&](const char* text) { return mentions(bytes, text); });
}

// Without any of these a file shows bare surfaces.
bool is_dressed(const std::string& bytes) {
  return mentions_any(bytes,
                      {"\"materials\"", "\"cameras\"", "\"KHR_lights_punctual\"", "\"skins\"", "\"animations\""});
}

// Receivers of ours have neither values nor materials; painted in another program they carry nothing but colours. A
// coloured surface with materials is a scene's, although --target would take its colours too.
bool is_vertex_mesh(const std::string& bytes) {
  if (mentions(bytes, "\"_ILLUMINATION\"")) return true;
  return mentions_any(bytes, {"\"generator\":\"chiaro\"", "\"COLOR_0\""}) && !is_dressed(bytes);
}

Inspection inspect_other_than_scene(const std::string& file) {
  if (renderer::has_extension(file, {".glb", ".gltf"})) return inspect_vertex_mesh(file);
  if (renderer::has_extension(file, {".json"})) {
    const auto json = nlohmann::json::parse(renderer::read_file(file), nullptr, false);
    return json.is_object() && json.contains("strokes") ? inspect_strokes(file) : inspect_light_file(file);
  }
  return inspect_picture(file);
}

Inspection inspect(const InspectCommand& options, const renderer::Control& control) {
  const std::string& file = options.file;
  if (renderer::has_extension(file, {".glb", ".gltf", ".json"})) {
    renderer::require_rereadable(file, "a regular file: it is read once to tell what it is");
  }
  if (renderer::has_extension(file, {".glb", ".gltf"}) && !is_vertex_mesh(renderer::read_file(file))) {
    return inspect_scene(file, options.load, control);
  }
  Inspection inspection = inspect_other_than_scene(file);
  const auto idle = given_for_nothing(*options.command, scene_option_names(), "with a file that is not a scene");
  inspection.warnings.insert(inspection.warnings.end(), idle.begin(), idle.end());
  return inspection;
}

int run_inspect(const InspectCommand& options) {
  Session session(options.common);
  Inspection inspection = inspect(options, session.control());
  session.stop_if_interrupted();
  session.warn(inspection.warnings);
  inspection.summary.emplace_back("warnings", json_list(inspection.warnings));
  session.finish(inspection.summary, aligned_rows(inspection.rows));
  return kDone;
}

}  // namespace

CommandRun add_inspect(CLI::App& command) {
  const auto options = std::make_shared<InspectCommand>();
  options->command = &command;
  add_input(command, {"file", "FILE", "Scene, light file, strokes, receivers, target, cache or image"}, options->file);
  add_scene_options(command, options->load);
  add_common_options(command, options->common);
  set_examples(command, "  chiaro inspect room.glb\n  chiaro inspect room.exr --json");
  return [options] { return run_inspect(*options); };
}

}  // namespace chiaro::cli

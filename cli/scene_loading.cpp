#include "cli/scene_loading.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "cli/error_context.h"
#include "renderer/core/error.h"
#include "renderer/io/gltf_container.h"
#include "renderer/io/light_file.h"
#include "renderer/io/referred_files.h"
#include "renderer/scene/texture_mip_maps.h"

namespace chiaro::cli {
namespace {

constexpr double kGiB = 1024.0 * 1024 * 1024, kMostGiBOfGlb = 4;

// Each file once, as a URI may be read in two ways.
std::uintmax_t size_of_referred_files(const std::filesystem::path& scene) {
  const std::vector<std::filesystem::path> files = renderer::referred_files(scene);
  std::uintmax_t size = 0;
  for (const std::filesystem::path& file : std::set(files.begin(), files.end())) {
    std::error_code missing;
    const std::uintmax_t bytes = std::filesystem::file_size(file, missing);
    if (!missing) size += bytes;
  }
  return size;
}

// The file and those that it refers to, as they are now.
std::vector<std::pair<std::filesystem::path, FileVersion>> versions_of_files(const std::filesystem::path& scene) {
  std::vector<std::pair<std::filesystem::path, FileVersion>> files{{scene, version_of(scene)}};
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(scene, unknown)) return files;
  for (const std::filesystem::path& file : renderer::referred_files(scene)) files.emplace_back(file, version_of(file));
  return files;
}

}  // namespace

LoadedStage load_stage(const std::string& path, const renderer::LoadOptions& load, const MaterialOptions& materials,
                       Session& session) {
  if (materials.albedo && materials.model == renderer::MaterialModel::kGltf) {
    session.warn("--materials gltf: does nothing with --albedo");
  }
  auto files = versions_of_files(path);
  renderer::LoadedScene loaded = renderer::load_gltf(path, load, session.control());
  session.warn(loaded.warnings);
  session.stop_if_interrupted();
  if (renderer::drawn_triangle_count(loaded.scene) == 0) {
    throw renderer::Error({path, "", "has no triangles", "a scene with surfaces"});
  }
  LoadedStage stage;
  stage.files = std::move(files);
  auto scene = std::make_unique<renderer::Scene>(
      renderer::with_materials(std::move(loaded.scene), material_override(materials)));
  renderer::make_mip_maps(*scene, session.control());
  stage.scene = std::move(scene);
  stage.lights = std::move(loaded.lights);
  stage.light_nodes = std::move(loaded.light_nodes);
  stage.tracer = std::make_unique<const renderer::RayTracer>(*stage.scene);
  session.stop_if_interrupted();
  return stage;
}

void require_copyable(const std::string& scene, const std::filesystem::path& copy) {
  renderer::require_rereadable(scene, "a scene file: the lights found are saved in a copy of it");
  if (renderer::writes_gltf_text(copy)) return;
  const double gib = double(size_of_referred_files(scene)) / kGiB;
  if (gib < kMostGiBOfGlb) return;
  throw renderer::Error({copy.string(), "",
                         fmt::format("cannot hold {}, whose buffers and images come to {:.1f} GiB", scene, gib),
                         "at most 4 GiB in a .glb; solve -o LIGHTS.gltf takes more"});
}

void require_unchanged(const LoadedStage& stage) {
  for (const auto& [file, version] : stage.files) {
    if (version_of(file) == version) continue;
    throw renderer::Error({file.string(), "", "was changed while its lights were sought", "the scene as it was"});
  }
}

renderer::Lights choose_lights(const LoadedStage& stage, const std::string& light_file,
                               const EnvironmentOptions& environment, Session& session) {
  std::vector<std::string> warnings;
  renderer::Lights lights =
      light_file.empty() ? stage.lights : renderer::load_lights(light_file, warnings, environment.config);
  if (std::none_of(lights.begin(), lights.end(), renderer::is_environment)) {
    std::copy_if(stage.lights.begin(), stage.lights.end(), std::back_inserter(lights), renderer::is_environment);
  }
  lights = naming_file(light_file.empty() ? stage.scene->path : light_file,
                       [&] { return with_environment(std::move(lights), environment, warnings); });
  session.warn(warnings);
  return lights;
}

renderer::Lights environment_of(const LoadedStage& stage, const EnvironmentOptions& options, Session& session) {
  renderer::Lights lights = choose_lights(stage, "", options, session);
  std::erase_if(lights, [](const renderer::Light& light) { return !renderer::is_environment(light); });
  return lights;
}

void require_light(const LoadedStage& stage, const renderer::Lights& lights, const std::string& expected) {
  if (!lights.empty() || renderer::has_emission(*stage.scene)) return;
  throw renderer::Error({stage.scene->path, "", "no light: the scene has no lights and nothing in it emits", expected});
}

}  // namespace chiaro::cli

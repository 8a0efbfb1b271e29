#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/environment_options.h"
#include "cli/file_version.h"
#include "cli/material_options.h"
#include "cli/session.h"
#include "renderer/io/load_gltf.h"
#include "renderer/scene/light.h"
#include "renderer/scene/scene.h"
#include "renderer/trace/ray_tracer.h"

namespace chiaro::cli {

// A scene ready for light transport. The ray tracer refers to the scene, so that stays where it is.
struct LoadedStage {
  std::unique_ptr<const renderer::Scene> scene;
  renderer::Lights lights;       // of the scene file
  std::vector<int> light_nodes;  // as LoadedScene's
  std::unique_ptr<const renderer::RayTracer> tracer;
  std::vector<std::pair<std::filesystem::path, FileVersion>> files;  // that it was read from
};

// Loads a glTF scene, replaces its materials, passes its warnings on, and builds the ray tracer. Error where it has no
// triangles.
LoadedStage load_stage(const std::string& path, const renderer::LoadOptions& load, const MaterialOptions& materials,
                       Session& session);

// Error, before any light is sought, for a scene that no copy with lights can be made of: a pipe or a device, which is
// read but once, or one whose files do not fit into a .glb.
void require_copyable(const std::string& scene, const std::filesystem::path& copy);

// Error where the file, or one that it refers to, is another than was loaded: what is made of it then is not of this
// scene.
void require_unchanged(const LoadedStage& stage);

// The lights of the file if one is named, else those of the scene; with the environment that the options ask for, or
// else the file's, or else the scene's, which belongs to it as emissive surfaces do.
renderer::Lights choose_lights(const LoadedStage& stage, const std::string& light_file,
                               const EnvironmentOptions& environment, Session& session);

// What shines whatever the light file says: the environment alone.
renderer::Lights environment_of(const LoadedStage& stage, const EnvironmentOptions& options, Session& session);

// Error ("no light") where there are no lights and nothing emits.
void require_light(const LoadedStage& stage, const renderer::Lights& lights, const std::string& expected);

}  // namespace chiaro::cli

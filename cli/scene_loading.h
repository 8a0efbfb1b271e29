#pragma once

#include <memory>
#include <string>

#include "cli/material_options.h"
#include "cli/session.h"
#include "renderer/scene/light.h"
#include "renderer/scene/scene.h"
#include "renderer/trace/ray_tracer.h"

namespace chiaro::cli {

// A scene ready for light transport. The ray tracer refers to the scene, so that stays where it is.
struct LoadedStage {
  std::unique_ptr<const renderer::Scene> scene;
  renderer::Lights lights;  // of the scene file
  std::unique_ptr<const renderer::RayTracer> tracer;
};

// Loads a glTF scene, replaces its materials, passes its warnings on, and builds the ray tracer. Error where it has no
// triangles.
LoadedStage load_stage(const std::string& path, const MaterialOptions& materials, Session& session);

// The lights of the file if one is named, else those of the scene.
renderer::Lights choose_lights(const LoadedStage& stage, const std::string& light_file);

bool has_emission(const renderer::Scene& scene);

// Error ("no light") where there are no lights and nothing emits.
void require_light(const LoadedStage& stage, const renderer::Lights& lights);

}  // namespace chiaro::cli

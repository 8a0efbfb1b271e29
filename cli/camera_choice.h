#pragma once

#include <array>
#include <optional>
#include <string>

#include "cli/session.h"
#include "renderer/scene/scene.h"

namespace chiaro::cli {

// The camera of that name; without a name the file's first, or, with a warning, one that sees the whole scene. Error
// naming the choices where there is no such camera.
renderer::Camera choose_camera(const renderer::Scene& scene, const std::string& name, Session& session);

struct FrameSize {
  std::optional<int> width, height;
};

// What is missing comes from the camera's aspect ratio (16:9 where it has none) and a width of 960.
std::array<int, 2> frame_size(const renderer::Camera& camera, const FrameSize& wanted);

}  // namespace chiaro::cli

#pragma once

#include <array>
#include <optional>
#include <string>

#include "cli/session.h"
#include "renderer/scene/scene.h"

namespace chiaro::cli {

struct FrameSize {
  std::optional<int> width, height;
};

// The camera of that name, the first of several; without a name the file's first, or one that sees the whole scene in a
// frame of this size. Warns of what was chosen among. Error naming the choices where there is no such camera.
renderer::Camera choose_camera(const renderer::Scene& scene, const std::string& name, const FrameSize& size,
                               Session& session);

// What is missing comes from the camera's aspect ratio (16:9 where it has none) and a width of 960.
std::array<int, 2> frame_size(const renderer::Camera& camera, const FrameSize& wanted);

}  // namespace chiaro::cli

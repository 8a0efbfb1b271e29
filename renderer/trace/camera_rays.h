#pragma once

#include "renderer/trace/ray_tracer.h"

namespace chiaro::renderer {

// Turns film positions into rays. They are not clipped: near and far planes are a rasterizer's need. The film's height
// always shows the camera's vertical field; its width follows the frame.
class CameraRays {
 public:
  CameraRays(const Camera& camera, int width, int height);
  // film: pixels from the upper left corner of the frame.
  Ray at(Vec2f film) const;

 private:
  Mat4f world_from_camera_;
  bool orthographic_;
  float half_width_, half_height_;  // at unit distance, or in metres where orthographic
  Vec2f size_;
};

}  // namespace chiaro::renderer

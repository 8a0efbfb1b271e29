#pragma once

#include "renderer/trace/ray_tracer.h"

namespace chiaro::renderer {

// A thin lens. What is at focus_distance from the camera's plane is sharp.
struct Lens {
  float radius = 0;          // metres; 0: a pinhole, all is sharp
  float focus_distance = 1;  // metres, along the camera's axis
  int blades = 0;            // of the aperture, a regular polygon of this radius; 0: a disc
  float rotation = 0;        // radians, of the polygon's first corner from the camera's right
};

// The place on the aperture, metres from its centre to the right and up, uniform over its area.
Vec2f sample_aperture(const Lens& lens, Vec2f u);

// Turns film positions into rays. They are not clipped: near and far planes are a rasterizer's need. The film's height
// always shows the camera's vertical field; its width follows the frame.
class CameraRays {
 public:
  CameraRays(const Camera& camera, int width, int height, const Lens& lens = {});
  // film: pixels from the upper left corner of the frame. u: random, of the place on the lens; the middle of a pinhole.
  Ray at(Vec2f film, Vec2f u = {0.5F, 0.5F}) const;

 private:
  Mat4f world_from_camera_;
  bool orthographic_;
  Lens lens_;
  float half_width_, half_height_;  // at unit distance, or in metres where orthographic
  Vec2f size_;
};

}  // namespace chiaro::renderer

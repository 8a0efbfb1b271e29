#pragma once
// The illumination of a target as a camera sees it.

#include "inverse/target/target.h"
#include "renderer/image/image.h"
#include "renderer/trace/ray_tracer.h"

namespace chiaro::inverse {

struct PictureFrame {
  const renderer::Camera& camera;
  int width = 0, height = 0;
};

// R, G, B: cd/m² of illumination, interpolated between the receivers that weigh anything; A: the part of the pixel that
// shows surface of which the target knows the illumination. Colours are multiplied by it. Four samples a pixel,
// or sixteen of scenes with blended surfaces.
renderer::Image illumination_picture(const renderer::RayTracer& tracer, const Target& target, const PictureFrame& frame,
                                     const renderer::Control& control = {});

}  // namespace chiaro::inverse

#pragma once
// Which receivers a stroke touches.

#include <vector>

#include "inverse/target/paint.h"
#include "inverse/target/surface_path.h"

namespace chiaro::inverse {

struct TouchedReceiver {
  std::size_t receiver = 0;
  float distance = 0;  // metres to the stroke's path, ≤ its radius
  float facing = 1;    // how much it faces the side painted from, > 0 to 1
};

struct BrushFootprint {
  std::vector<TouchedReceiver> touched;  // ascending
  std::vector<std::size_t> far_points;   // numbers of points of the path farther than the radius from any surface …
  std::vector<std::size_t> far_images;   // … and of those whose mirror images are
};

// Receivers within the stroke's radius of its path as it lies on the surface, or of the mirror image of it. Distance is
// measured along the fronts of the receivers' triangles, those that their normals point from, or through space; without
// triangles always through space. With `facing`, those only whose normal turns to the side that the nearest place of
// the path lies on, fading where surfaces turn away. A place on the edge between two surfaces lies on both.
// control: to be interrupted.
BrushFootprint brush_footprint(const ReceiverSurface& surface, const Stroke& stroke,
                               const renderer::Control& control = {});

}  // namespace chiaro::inverse

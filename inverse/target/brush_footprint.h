#pragma once
// Which receivers a stroke touches.

#include <vector>

#include "inverse/target/paint.h"
#include "inverse/transport/box_tree.h"

namespace chiaro::inverse {

struct TouchedReceiver {
  std::size_t receiver = 0;
  float distance = 0;  // metres to the stroke's path, ≤ its radius
  float facing = 1;    // how much it faces the side painted from, > 0 to 1
};

// The receivers' triangles, to find the side that a stroke was painted from.
BoxTree make_surface_tree(const Receivers& receivers);

// Receivers within the stroke's radius of its path (the segments between its points; one point is a dab), ascending.
// With `facing`, those only whose normal turns to the side that the nearer end of the closest segment lies on: the
// normal of the triangle nearest to it. A triangle and not a vertex, as the vertices of a top and of its edge share
// their places. A point on the edge between two surfaces lies on both. Where surfaces turn away, `facing` fades.
std::vector<TouchedReceiver> brush_footprint(const Receivers& receivers, const BoxTree& surface, const Stroke& stroke);

}  // namespace chiaro::inverse

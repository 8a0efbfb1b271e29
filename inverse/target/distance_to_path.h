#pragma once
// How far receivers are from a stroke's path.

#include <cstdint>
#include <vector>

#include "inverse/target/surface_path.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {

struct PathDistance {
  std::uint32_t receiver = 0;
  double distance = 0;      // metres, ≤ radius
  std::uint32_t piece = 0;  // of the path: the nearest
};

// Along the surface, on the fronts of triangles: on the side that their corners' normals point to. Surfaces that meet
// within 1/200 of the radius, or of all receivers' extent where that is less, but not beyond a twentieth of the spacing
// of receivers, are one: what stands on a floor ends it, and the way goes on up there. Ascending. control: to be
// interrupted.
std::vector<PathDistance> distances_along_surface(const ReceiverSurface& surface, const SurfacePath& path,
                                                  double radius, const renderer::Control& control);

// Straight through space. Ascending. control: to be interrupted.
std::vector<PathDistance> distances_through_space(const ReceiverSurface& surface, const SurfacePath& path,
                                                  double radius, const renderer::Control& control);

}  // namespace chiaro::inverse

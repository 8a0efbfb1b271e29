#pragma once

#include <vector>

#include "renderer/core/control.h"
#include "renderer/scene/scene.h"

namespace chiaro::inverse {

struct SurfaceMesh {
  std::vector<renderer::Vec3f> positions;
  std::vector<renderer::Vec3f> normals;
  std::vector<renderer::Triangle> triangles;
};

// Splits edges longer than max_edge (metres) at their middle until none is left that floats have a middle of. An edge
// shared by two triangles is split for both, so that the mesh stays whole. Old vertices keep their numbers; new normals
// are interpolated.
void split_long_edges(SurfaceMesh& mesh, float max_edge, const renderer::Control& control = {});

// How many vertices split_long_edges would leave, up to float rounding, without making them. Counting ends soon after
// `limit` is passed.
double vertices_after_split(const SurfaceMesh& mesh, float max_edge, double limit);

}  // namespace chiaro::inverse

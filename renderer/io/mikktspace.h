#pragma once
// Tangents as all programs that bake normal maps make them.

#include <vector>

#include "renderer/scene/scene.h"

namespace chiaro::renderer {

// Per corner of a triangle, in the order of `triangles`: the unit direction in which u grows, at right angles to the
// normal, and in w the sign of dot(cross(normal, tangent), the direction in which v grows). `normals` (unit) and `uv`
// have the length of `positions`. Vertices of the same position, normal and uv are one, whatever their index.
// Source: Morten S. Mikkelsen, Simulation of Wrinkled Surfaces Revisited, 2008, and his mikktspace.c, at its default
// angular threshold of 180 degrees. Where the coordinates leave no direction, (1, 0, 0).
std::vector<Vec4f> mikktspace_tangents(const std::vector<Vec3f>& positions, const std::vector<Vec3f>& normals,
                                       const std::vector<Vec2f>& uv, const std::vector<Triangle>& triangles);

}  // namespace chiaro::renderer

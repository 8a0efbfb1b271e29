#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "renderer/trace/ray_tracer.h"

namespace chiaro::inverse {

using renderer::Box3f;
using renderer::Vec3f;

// Candidate light positions in the middle of the cells of a regular grid over a region, x fastest.
struct LightGrid {
  Box3f region;                    // where lights may stand
  Vec3f origin;                    // of node (0, 0, 0), metres
  Vec3f spacing;                   // metres
  std::array<int, 3> counts{};     // nodes along x, y, z
  std::vector<int> light_of_node;  // index into positions, -1: left out (inside a solid)
  std::vector<Vec3f> positions;    // of the lights kept, in the order of their nodes
};

struct LightGridOptions {
  std::array<int, 3> counts{};       // 0, 0, 0: from the region's shape, for about so many nodes:
  std::optional<Box3f> region = {};  // default: the scene's bounds, a little inside
  double lights = 700;
  double error = 0;  // of interpolation, for choose_light_grid(); 0: whatever comes of the above
};

// Nodes inside solids, and those that touch a surface, are left out. Error where none is left ("no light possible").
LightGrid make_light_grid(const renderer::RayTracer& tracer, const LightGridOptions& options);

// `--region`: the world bounds of a node's instances by name, or "x0,y0,z0,x1,y1,z1". Error naming what is wrong.
Box3f parse_region(const renderer::Scene& scene, const std::string& text);

}  // namespace chiaro::inverse

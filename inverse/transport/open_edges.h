#pragma once
// Where a surface ends.

#include <array>
#include <span>
#include <vector>

#include "renderer/core/vec.h"

namespace chiaro::inverse {

using WorldCorners = std::array<renderer::Vec3f, 3>;

// Of one triangle. Edge k lies across from corner k.
struct OpenEdges {
  std::array<bool, 3> edge{};    // no other triangle shares it
  std::array<bool, 3> corner{};  // an open edge ends there, of this triangle or of another
};

// One for each triangle. Corners are the same where their coordinates are, whatever mesh they come from.
std::vector<OpenEdges> find_open_edges(std::span<const WorldCorners> triangles);

}  // namespace chiaro::inverse

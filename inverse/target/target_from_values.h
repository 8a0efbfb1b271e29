#pragma once
// Illumination known at points of the surface, brought to the receivers around them: what painted pictures and
// lightmaps have in common.

#include <optional>
#include <span>
#include <vector>

#include "inverse/target/target.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {

// Wanted at a point of the surface.
struct SurfaceValue {
  Vec3f position;      // world, metres
  Vec3f normal;        // unit, of the side that is seen
  Vec3f illumination;  // cd/m², ≥ 0
  float weight = 1;    // ≥ 0: the area that it stands for, on the surface or in the picture
};

struct TargetFromValues {
  // Weight 0 where no value is; 1 on average elsewhere. Samples of receivers lie where the values nearest to them do.
  Target target;
  std::size_t not_placed = 0;  // values where the surface has no receivers
};

// The values at receivers whose linear interpolation over the triangles comes closest to `values`, by their weights. A
// receiver weighs what falls to it. Its standard error comes from the values' scatter around the interpolation.
TargetFromValues target_from_values(const Receivers& receivers, std::span<const SurfaceValue> values,
                                    const renderer::Control& control = {});

// Both targets of the same receivers, each value by its weights; sampled where the heavier is.
Target combine(const Target& a, const Target& b);

}  // namespace chiaro::inverse

#pragma once
// Which gather point stands for a spot of the surface: the nearest in position and orientation that is seen from there,
// a little above the surface, so that no light leaks below what stands or lies on a lit surface, or into solids.

#include <optional>
#include <vector>

#include "inverse/transport/sample_tree.h"
#include "renderer/trace/ray_tracer.h"

namespace chiaro::inverse {

class NearestGatherPoint {
 public:
  // spacing: metres between neighbours, about. Keeps a reference to the tracer.
  NearestGatherPoint(const renderer::RayTracer& tracer, std::vector<renderer::SurfaceSample> points, float spacing);

  // Its index; nothing where none of the nearest is seen.
  std::optional<std::uint32_t> find_seen(const renderer::SurfaceSample& at) const;
  // The nearest, seen or not.
  std::uint32_t find_nearest(const renderer::SurfaceSample& at) const;

 private:
  const renderer::RayTracer& tracer_;
  SampleTree tree_;
};

}  // namespace chiaro::inverse

#include "inverse/transport/nearest_gather_point.h"

#include <array>

#include "inverse/transport/mutual_visibility.h"

namespace chiaro::inverse {

using renderer::SurfaceSample;

namespace {

constexpr std::size_t kCandidates = 8;

}  // namespace

NearestGatherPoint::NearestGatherPoint(const renderer::RayTracer& tracer, std::vector<SurfaceSample> points,
                                       float spacing)
    : tracer_(tracer), tree_(std::move(points), spacing) {}

std::optional<std::uint32_t> NearestGatherPoint::find_seen(const SurfaceSample& at) const {
  const std::uint32_t nearest = find_nearest(at);
  if (see_each_other(tracer_, at, tree_.samples()[nearest])) return nearest;
  std::array<std::uint32_t, kCandidates> found{};
  const std::size_t count = tree_.find_nearest(at, found);
  for (std::size_t k = 1; k < count; ++k) {
    if (see_each_other(tracer_, at, tree_.samples()[found[k]])) return found[k];
  }
  return std::nullopt;
}

std::uint32_t NearestGatherPoint::find_nearest(const SurfaceSample& at) const {
  std::uint32_t nearest = 0;
  tree_.find_nearest(at, {&nearest, 1});
  return nearest;
}

}  // namespace chiaro::inverse

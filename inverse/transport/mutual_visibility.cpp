#include "inverse/transport/mutual_visibility.h"

namespace chiaro::inverse {

using renderer::SurfaceSample;
using renderer::Vec3f;

bool see_each_other(const renderer::RayTracer& tracer, const SurfaceSample& a, const SurfaceSample& b) {
  constexpr float kLift = 0.1F;
  const float lift = kLift * length(b.position - a.position);
  const auto beside = [](const SurfaceSample& at) { return renderer::offset_point(at.position, at.normal); };
  const auto above = [&](const SurfaceSample& at) { return beside(at) + lift * at.normal; };
  const auto is_free = [&](const SurfaceSample& at) { return !tracer.occluded_between(beside(at), above(at), 0); };
  return !tracer.occluded_between(above(a), above(b), 0) && is_free(a) && is_free(b);
}

}  // namespace chiaro::inverse

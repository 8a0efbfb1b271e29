#pragma once

#include "inverse/solve/observations.h"
#include "inverse/transport/gather_operator.h"

namespace chiaro::inverse {

// Indirect light at the important vertices from lights at any position, computed there and not interpolated.
class ExactIndirect {
 public:
  // Keeps a reference to the tracer. settings: of the bake, which it surpasses in samples.
  ExactIndirect(const renderer::RayTracer& tracer, const std::vector<renderer::SurfaceSample>& receivers,
                const BakeSettings& settings);

  // Gives each light the correction that makes its response exact where it stands now, or, for a light that is
  // direct_only, takes its indirect light off.
  void correct(const LightResponse& response, LightEstimates& lights) const;

 private:
  const renderer::RayTracer& tracer_;
  GatherOperator gather_;
};

}  // namespace chiaro::inverse

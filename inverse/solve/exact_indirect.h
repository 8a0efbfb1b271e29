#pragma once

#include "inverse/solve/observations.h"
#include "inverse/transport/gather_operator.h"

namespace chiaro::inverse {

// Indirect light at the important vertices from lights at any position, computed there and not interpolated.
class ExactIndirect {
 public:
  // Keeps a reference to the tracer. settings: of the bake, which it surpasses in samples. control: to be interrupted.
  ExactIndirect(const renderer::RayTracer& tracer, const std::vector<renderer::SurfaceSample>& receivers,
                const BakeSettings& settings, const renderer::Control& control = {});

  // Gives each light the correction that makes its response exact where it stands now.
  void correct(const LightResponse& response, LightEstimates& lights) const;
  // The same by path tracing: slower and noisier, but right where gather points are too far apart, and for materials
  // that are not Lambertian. By as many paths as it takes until their noise hardly adds to that of the target.
  void correct_by_paths(const LightResponse& response, const Observations& observations, LightEstimates& lights) const;
  // Indirect illumination of some of the receivers under a unity light, by this many paths.
  std::vector<Vec3f> traced(const LightResponse& response, const std::vector<std::size_t>& receivers,
                            const Eigen::Vector3d& position, std::size_t paths) const;

  const renderer::RayTracer& tracer() const { return tracer_; }
  const GatherOperator& gather() const { return gather_; }

 private:
  renderer::Illumination traced_so_well(const LightResponse& response, const Observations& observations,
                                        const LightEstimate& light, int most) const;

  const renderer::RayTracer& tracer_;
  BakeSettings settings_;
  GatherOperator gather_;
};

}  // namespace chiaro::inverse

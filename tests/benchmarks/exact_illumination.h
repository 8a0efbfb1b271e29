#pragma once

#include <vector>

#include "inverse/solve/solve.h"
#include "tests/benchmarks/random_light_sets.h"

namespace chiaro::benchmarks {

// Illumination of some of a stage's receivers without the noise of paths.
class ExactIllumination {
 public:
  // Keeps a reference to the stage's tracer.
  explicit ExactIllumination(const Stage& stage);

  // ‖illumination by the lights found − by the true ones‖ / ‖the latter‖
  double error(const std::vector<renderer::PointLight>& truth, const std::vector<inverse::FoundLight>& found) const;

 private:
  std::vector<renderer::Vec3f> illumination(const std::vector<renderer::PointLight>& lights) const;

  const renderer::RayTracer& tracer_;
  std::vector<renderer::SurfaceSample> samples_;
  inverse::GatherOperator gather_;
};

}  // namespace chiaro::benchmarks

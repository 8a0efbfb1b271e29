#pragma once

#include "inverse/solve/observations.h"

namespace chiaro::inverse {

// Receivers that lights are not fitted to, which tell whether a further light is there or fits noise.
class HeldOut {
 public:
  // Keeps a reference to the tracer. settings: of the bake.
  HeldOut(const renderer::RayTracer& tracer, const std::vector<renderer::SurfaceSample>& receivers,
          Observations observations, const BakeSettings& settings);
  HeldOut(const HeldOut&) = delete;
  HeldOut& operator=(const HeldOut&) = delete;

  // Weighted, of each receiver, by exact illumination. Their squares would be those of a few receivers beside lights.
  Eigen::VectorXd residuals(const LightEstimates& lights) const;

 private:
  const renderer::RayTracer& tracer_;
  Observations observations_;
  GatherOperator gather_;
  TransportCache nothing_;
  LightResponse response_;
};

// Whether the second are smaller than chance makes them: a paired test of their mean, at three standard errors.
bool clearly_smaller(const Eigen::VectorXd& before, const Eigen::VectorXd& after);

}  // namespace chiaro::inverse

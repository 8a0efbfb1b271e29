#pragma once

#include <deque>

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
  // The same with indirect light, at 1 cd, that is known already.
  Eigen::VectorXd residuals(const LightEstimates& lights, const std::vector<const Column*>& indirect) const;
  std::vector<Column> indirect(const LightEstimates& lights) const;

 private:
  const renderer::RayTracer& tracer_;
  Observations observations_;
  GatherOperator gather_;
  TransportCache nothing_;
  LightResponse response_;
};

// Residuals of the sets of one search: indirect light is computed once wherever several of their lights come to stand.
class HeldOutResiduals {
 public:
  // near: metres to a place so near that indirect light hardly is another. Keeps a reference.
  HeldOutResiduals(const HeldOut& held_out, double near) : held_out_(held_out), near_(near) {}

  Eigen::VectorXd of(const LightEstimates& lights);

 private:
  struct Known {
    Eigen::Vector3d position;
    Column indirect;
  };
  const Column* find(const Eigen::Vector3d& position) const;

  const HeldOut& held_out_;
  double near_;
  std::deque<Known> known_;
};

// Whether the second are smaller than chance makes them: a paired test of their mean, at so many standard errors.
bool clearly_smaller(const Eigen::VectorXd& before, const Eigen::VectorXd& after, double standard_errors = 3);

}  // namespace chiaro::inverse

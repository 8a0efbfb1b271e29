#pragma once

#include "inverse/solve/known_places.h"
#include "inverse/solve/observations.h"

namespace chiaro::inverse {

struct HeldOutFit {
  double error;        // by the objective
  double relative_l2;  // (3.6)
};

// Receivers drawn by themselves, whatever lights are fitted to, which tell whether a further light is there or fits
// noise. Where a target has few receivers they are mostly the same.
class HeldOut {
 public:
  // Keeps a reference to the tracer. judged: the same observations, as the objective weighs them. settings: of the
  // bake. control: to be interrupted.
  HeldOut(const renderer::RayTracer& tracer, const std::vector<renderer::SurfaceSample>& receivers,
          Observations observations, Observations judged, const BakeSettings& settings,
          const renderer::Control& control = {});
  HeldOut(const HeldOut&) = delete;
  HeldOut& operator=(const HeldOut&) = delete;

  // What each brings by bounces at 1 cd, computed there and not interpolated.
  std::vector<Column> indirect(const LightEstimates& lights) const;
  // Gives the lights the intensities that come closest, within the observations' rules.
  HeldOutFit refit(LightEstimates& lights, const std::vector<const Column*>& indirect) const;
  // Leads the lights to where they come closest, in places of `search`, as if their light by bounces stayed the same.
  void descend(const LightResponse& search, LightEstimates& lights, const std::vector<const Column*>& indirect) const;
  // Weighted, of each receiver. Their squares would be those of a few receivers beside lights.
  Eigen::VectorXd residuals(const LightEstimates& lights, const std::vector<const Column*>& indirect) const;
  // By the objective, and (3.6).
  double error(const Eigen::VectorXd& residuals) const;
  double relative_l2(const Eigen::VectorXd& residuals) const;
  // Of the target's brightness, the part on receivers of which these residuals are a large part, and not by noise.
  double part_missed(const Eigen::VectorXd& residuals) const;

 private:
  const renderer::RayTracer& tracer_;
  Observations observations_, judged_;
  GatherOperator gather_;
  TransportCache nothing_;
  LightResponse response_;
};

// The sets of one search: indirect light is computed once wherever several of their lights come to stand.
class HeldOutSets {
 public:
  // near: metres to a place so near that indirect light hardly is another. Keeps a reference.
  HeldOutSets(const HeldOut& held_out, double near) : held_out_(held_out), indirect_(near) {}

  Eigen::VectorXd residuals(const LightEstimates& lights);
  HeldOutFit refit(LightEstimates& lights);
  // Leads the lights to where they come closest, in places of `search`, if that is closer than `least`, the error by
  // the objective. False: it is not, and they stay.
  bool lead_closer(const LightResponse& search, LightEstimates& lights, HeldOutFit& least);

 private:
  // Until the next call.
  std::vector<const Column*> indirect(const LightEstimates& lights);

  const HeldOut& held_out_;
  KnownPlaces<Column> indirect_;
};

// Whether the second are smaller than chance makes them: a paired test of their mean, at so many standard errors.
bool clearly_smaller(const Eigen::VectorXd& before, const Eigen::VectorXd& after, double standard_errors = 3);

}  // namespace chiaro::inverse

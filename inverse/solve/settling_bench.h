#pragma once

#include <functional>

#include "inverse/solve/light_intervals.h"

namespace chiaro::inverse {

// Receivers that lights are settled by, and what they want of them. In all of this indirect[j] is what light j brings
// by bounces at 1 cd, and stays what it is as lights move.
struct SettlingBench {
  const LightResponse& response;  // of direct light alone
  Observations observations;
  std::function<bool()> stop = {};  // if any: whether to end now

  bool stops() const { return stop && stop(); }
  // To where they fit best, and as bright as they do (instrumental_fit.h).
  void descend(const std::vector<Column>& indirect, LightEstimates& lights) const;
  Column illumination(const std::vector<Column>& indirect, const LightEstimates& lights) const;
  LightIntervals intervals(const std::vector<Column>& indirect, const LightEstimates& lights) const;
  // Of what one light brings, weighted.
  double norm(const Column& light) const;
  // Whether the first illumination leaves less than the other by this part of the squared error, and everywhere a
  // little rather than much at a few receivers: by so many standard errors of relative residuals.
  bool explains_more(const Column& one, const Column& other, double gain, double standard_errors) const;
  // The same by what most receivers say: those that are far beyond noise, as where shadows are not where the target has
  // them, say no more than that they are. Where noise is not known they say all.
  bool explains_more_to_most(const Column& one, const Column& other, double gain, double standard_errors) const;
  // Weighted as explains_more_to_most() counts them beside this illumination.
  Observations as_most_say(const Column& illumination) const;
};

}  // namespace chiaro::inverse

#pragma once
// Lights fitted over many receivers whose indirect light is path traced, and noisy: a least-squares fit would dim what
// noise varies with. Residuals are made orthogonal to the derivatives of direct light, which has none, and not to those
// of all light (instrumental variables).
// Sources: Reiersøl, Confluence Analysis by Means of Instrumental Sets of Variables, 1945; Holland, Welsch, Robust
// Regression Using Iteratively Reweighted Least-Squares, 1977 (weights after Geman and McClure, 1987).

#include <functional>

#include "inverse/solve/light_intervals.h"

namespace chiaro::inverse {

// Light by bounces of a unity light, from what a light of this intensity was traced to bring and what it brings
// directly at 1 cd. Of a channel that does not shine nothing is known, and its indirect light counts as none.
Column unity_indirect(const Column& traced, const Column& direct, const Eigen::Array3d& intensity);

// In all of these `response` is of direct light alone, and indirect[j] what light j brings by bounces at 1 cd.

// Gauss–Newton steps of positions and intensities, visibility and indirect light held during each. Receivers whose
// shadow is not where the target has it say nothing about which way to go, and would pull the lights aside: their
// residuals are far beyond those of all others, and weigh little (iteratively reweighted least squares). stop: if any,
// whether to end now.
void descend_with_instruments(const LightResponse& response, const Observations& observations,
                              const std::vector<Column>& indirect, LightEstimates& lights,
                              const std::function<bool()>& stop = {});

// The intensities alone, none negative, with weights by which residuals cannot take off the mean: noise is not
// symmetric. Where it is known, only what is far beyond it loses weight, and otherwise fireflies do.
void fit_intensities_with_instruments(const LightResponse& response, const Observations& observations,
                                      const std::vector<Column>& indirect, LightEstimates& lights);

// How sure lights so fitted are (light_intervals.h).
LightIntervals intervals_with_instruments(const LightResponse& response, const Observations& observations,
                                          const std::vector<Column>& indirect, const LightEstimates& lights);

}  // namespace chiaro::inverse

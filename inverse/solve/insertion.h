#pragma once

#include <optional>

#include "inverse/solve/observations.h"

namespace chiaro::inverse {

// Places for one more light, each with the intensity that explains most of what `lights` leave, the best few of: the
// best of the grid's, and the best at every distance in front of the receivers that lack most. A light right beside a
// surface, or inside a fixture, is seen by hardly anything else. Source: the linear minimisation step of Boyd,
// Schiebinger, Recht, The alternating descent conditional gradient method for sparse inverse problems, 2017.
LightEstimates propose_insertions(const LightResponse& response, const Observations& observations,
                                  const LightEstimates& lights);

// The place of these whose direct light explains most of `residual`, brightness fitted; nothing where none explains as
// much as this (squared norm, weighted).
std::optional<LightEstimate> propose_directly_lit(const LightResponse& response, const Observations& residual,
                                                  const std::vector<Eigen::Vector3d>& places, double least_gain);

// The intensity with which a light of this column explains most of what is wanted, and how much (squared norm).
double fit_intensity(const Observations& observations, const Column& column, LightEstimate& light);

// Places inside the region in front of some receivers, at this distance along the normal and around it.
std::vector<Eigen::Vector3d> places_in_front(const LightResponse& response, const std::vector<std::size_t>& receivers,
                                             float distance);

}  // namespace chiaro::inverse

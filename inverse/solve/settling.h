#pragma once
// What lights settle by: receivers that tell where they are, and a trace of every light there.

#include "inverse/solve/directly_lit.h"
#include "inverse/solve/free_lights.h"
#include "inverse/solve/observe_target.h"
#include "inverse/solve/traced_light.h"

namespace chiaro::inverse {

// The target, and the receivers that lights are settled by.
struct Settling {
  const Target& target;
  const DirectlyLit& all;  // receivers
  ReceiverDraw draw;
  DirectlyLit some;  // receivers: those drawn
  std::size_t held;  // of the first lights, that stay
  double near;       // metres: of all light, that by bounces hardly changes

  // brightness: of each receiver, by which the brightest are drawn; may be empty where all are.
  Settling(const SolveProblem& problem, const DirectlyLit& all_receivers, const Eigen::VectorXd& brightness,
           std::size_t receivers, std::size_t held_lights);
};

std::vector<Column> direct_columns(const DirectlyLit& receivers, const LightEstimates& lights);

// Those of the lights that may move. drawn: of the receivers that lights are settled by.
FreeLights free_lights(const Settling& with, const LightEstimates& lights, const FreshTrace& drawn);

// What the receivers drawn want of the free lights.
Observations wanted_of(const Settling& with, const FreeLights& free, const FreshTrace& drawn);

// Light by bounces becomes that of where the lights are now: by the difference of two traces of few but the same paths,
// whose noise is mostly the same as well. before, now: first parts of the trace, of all lights.
void carry_along(const Settling& with, const FreshTrace& before, const FreshTrace& now, FreeLights& free);

// The illumination that was traced becomes that of the lights where they are now: none is negative by what was taken
// off.
void follow(const Settling& with, const FreeLights& free, FreshTrace& traced);

// Those that are held, then the free ones where they are now.
LightEstimates joined(const Settling& with, const LightEstimates& lights, const FreeLights& free);

}  // namespace chiaro::inverse

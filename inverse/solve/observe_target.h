#pragma once

#include "inverse/solve/observations.h"
#include "inverse/target/target.h"

namespace chiaro::inverse {

// Receivers drawn from all of a target's.
struct ReceiverDraw {
  std::vector<std::size_t> chosen;  // ascending
  std::vector<double> probability;  // with which each of them was to be chosen
};

// At most `most` receivers of positive weight, spread evenly over all of them.
ReceiverDraw draw_evenly(const Target& target, std::size_t most);
// Where there are more, half of them are the brightest by this, of every receiver of the target, and the others spread
// evenly over the rest: the little that a light shines upon from near by tells most of where it is.
ReceiverDraw draw_brightest_and_evenly(const Target& target, const Eigen::VectorXd& brightness, std::size_t most);

// Evenly, or, where that would leave out most of the few that are lit, with the brightest of the target.
ReceiverDraw draw_with_the_lit(const Target& target, std::size_t most);

// What (3.6) asks of these receivers, each by itself. `fixed`: their light without the lights sought, cd/m².
Observations observe_target(const Target& target, const ReceiverDraw& draw, const std::vector<Vec3f>& fixed);

// The same with what the target says of its noise (pooled_errors.h).
Observations with_noise(Observations observations, const Target& target, const std::vector<std::size_t>& chosen);

// sqrt(Σ weight · se²) / sqrt(Σ weight · Ψ²) over all receivers; 0 where the target does not say.
double target_noise(const Target& target);

}  // namespace chiaro::inverse

#pragma once

#include "inverse/solve/exact_indirect.h"
#include "inverse/solve/held_out.h"
#include "inverse/solve/light_clusters.h"
#include "inverse/solve/solve.h"
#include "inverse/solve/stage_clock.h"

namespace chiaro::inverse {

inline constexpr double kDefaultThesisThreshold = 0.12;  // of the lightcut, before the last optimisation

// The lights of a search, by either method.
struct Optimum {
  LightEstimates lights;
  LightEstimates start;  // before the last optimisation
  Termination termination = Termination::kNoFurtherExplainsMore;
  std::vector<int> cut;  // of the light tree, nodes
  std::vector<LightSet> error_curve{};
  bool refits = false;   // the lights do not explain the target, or are tied together: their intensities come last
  bool settles = false;  // the lights explain the target, or nearly so, and each may move by itself …
  std::size_t held = 0;  // … but for so many of the first
  bool curve_by_held_out = false;  // its errors are those at held-out receivers, or else at the important ones
};

// What the search has come to.
struct JointLights {
  LightEstimates beside_surfaces, others;
  double error = 0, noise = 0;  // of the others
  double times_noise = 0;       // error of the search, which is by noise of target and transport
  Eigen::VectorXd held_out;     // residuals of these receivers; empty: there are none
  bool out_of_time = false;
  LightEstimates start;
  std::vector<int> cut;  // of the light tree, nodes
  std::vector<LightSet> error_curve;
  std::vector<LightEstimates> sets;  // of the others: the best found of 1, 2, … lights
};

// What is known before the search.
struct JointSearch {
  const SolveProblem& problem;
  const SolveOptions& options;
  const renderer::Control& control;
  const LightResponse& response;
  const ExactIndirect& exact;
  const Observations& searched;        // no receiver hides the light of all others
  const Observations& judged;          // as the objective judges them
  const Observations& reported;        // as (3.6) judges them
  double transport_error;              // of interpolated indirect light, relative
  const HeldOut* held_out;             // absent where lights beside surfaces were found, and without noise
  const JointLights* begun = nullptr;  // by fewer important vertices: this search goes on from them
};

// Those beside surfaces come first.
LightEstimates all_of(const JointLights& found);

// They leave nothing but noise, or nearly so.
bool is_explained(const JointLights& found);

// At most, or exactly where so many are asked for.
int most_lights(const SolveOptions& options);

// Rules that speak of more than a light's place.
bool ties_lights_together(const SolveProblem& problem);

// No rule keeps lights apart.
bool may_share_places(const SolveProblem& problem);

// Sets of an earlier solve that serve: those of the number asked for, or no more than that.
std::vector<LightEstimates> earlier_sets(const SolveOptions& options);

// From a cut of the tree to the number of lights, where they stand and how bright they are: insertion, joint descent,
// elimination (choose_light_count.h). `beside_surfaces`: lights found before, which stay.
JointLights search_jointly(const JointSearch& search, LightEstimates beside_surfaces, const LightTree& tree,
                           StageClock& clock);

// The lights that are left of them, as many as asked for: those far from the target with intensities by many receivers.
Optimum conclude(const JointSearch& search, const JointLights& found, StageClock& clock);

}  // namespace chiaro::inverse

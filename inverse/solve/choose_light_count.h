#pragma once
// How many lights, and which: the error of the best found set of every size, and the smallest size that explains the
// target.

#include <limits>
#include <vector>

#include "inverse/solve/exact_indirect.h"
#include "inverse/solve/held_out.h"
#include "inverse/solve/light_clusters.h"
#include "inverse/solve/refine_joint.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {

inline constexpr double kKnee = 1.25;  // further lights must lower an error that is not noise by this factor

// What a search by fewer receivers has come to.
struct BegunSearch {
  std::vector<LightEstimates> sets;
  std::size_t lights = 0;  // of the set that it chose
};

struct LightCountOptions {
  int max_lights = 32;
  int exact_lights = 0;  // 0: chosen here; fewer where all of them would not shine
  double seconds_left = std::numeric_limits<double>::infinity();  // some light is found even without any
  double transport_error = 0;                                     // of interpolated indirect light, relative
  const ExactIndirect* exact = nullptr;  // sets are judged by it; absent: by interpolated light alone
  const HeldOut* held_out = nullptr;     // tell how many lights there are; absent: the error of the fit does
  renderer::Control control{};
  std::vector<LightEstimates> earlier{};  // known already: they are refined, and no others are looked for
  BegunSearch begun{};                    // the search goes on from there
  // The same, as the objective weighs them: sets of fewer lights than the target takes are those that come closest by
  // it. Absent: by the weights of the search, which may give up what is brightest.
  const Observations* judged = nullptr;
};

struct LightCountResult {
  LightEstimates lights;
  double error = 0;
  std::vector<LightEstimates> sets;  // the best found of 1, 2, … lights; empty where there is none
  Eigen::VectorXd held_out;          // residuals under the lights; empty: none are held out
  int refinements = 0;
  bool out_of_time = false;
};

// Every cut of the light tree is refined jointly; then lights are inserted where the residual asks for them, and taken
// away one by one, as long as that gains anything (backward elimination). A search that goes on takes sets of far fewer
// lights than were chosen as they are, but for their intensities.
LightCountResult choose_light_count(const LightResponse& response, const Observations& observations,
                                    const LightTree& tree, const LightCountOptions& options);

}  // namespace chiaro::inverse

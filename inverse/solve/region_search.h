#pragma once

#include <memory>

#include "inverse/solve/important_vertices.h"
#include "inverse/solve/optimize_jointly.h"
#include "inverse/solve/prepare_transport.h"

namespace chiaro::inverse {

// What is searched with, whatever the region.
struct SearchBasis {
  const SolveOptions& options;
  const renderer::Control& control;
  Importance importance;
  std::vector<renderer::SurfaceSample> samples;  // the important vertices
  Observations published;                        // what they want, by the weights of (3.6)
  bool region_may_grow;                          // nobody says where it ends, nor do earlier lights
};

// Lights sought in one region, from its transport up to the trace that they are judged by.
class RegionSearch {
 public:
  // Keeps references. region: of the light grid; absent: as the problem says. before: a search in another region, or of
  // another basis, which has made what is the same in both; absent: this is the first.
  RegionSearch(std::shared_ptr<const SearchBasis> basis, const SolveProblem& problem,
               const std::optional<Box3f>& region, const RegionSearch* before, StageClock& clock);
  RegionSearch(const RegionSearch&) = delete;
  RegionSearch& operator=(const RegionSearch&) = delete;

  // Where a larger region may hold better lights: those found press against its border, and do not explain the target
  // or take a crowd of them to.
  std::optional<Box3f> wider_region() const;
  // Nothing but noise is left, or little of what is wanted.
  bool comes_close() const;
  // Of two searches, the one that came closer, or as close with fewer lights.
  bool is_clearly_better_than(const RegionSearch& other) const;

  // False where what shines already leaves no more than noise, and held-out receivers see no more in the lights found.
  bool brings_closer() const;
  // The lights found miss a part of what receivers want that they were not fitted to.
  bool was_misled() const;
  // So many lights were found, and little else is left, that each important vertex must tell of many: shadows' edges
  // at few vertices then hold up descents, so that two stand for three. A search by more of them goes on from here.
  bool has_many() const;
  // Of two searches with other important vertices.
  bool misses_less_than(const RegionSearch& other) const;

  // The lights that are left. Once, at last.
  Optimum conclude(StageClock& clock) const;
  // Of lights, (3.6), at held-out receivers, which there must be.
  double held_out_error(const LightEstimates& lights) const;
  // Of lights, (3.6), at the important vertices, by light that is not interpolated. Joint method alone.
  double exact_error(LightEstimates lights) const;
  // The one of these that the error curve has.
  double error_in_curve(const LightEstimates& lights, bool by_held_out) const {
    return by_held_out ? held_out_error(lights) : exact_error(lights);
  }

  const std::shared_ptr<const SearchBasis> basis;
  const SolveProblem problem;
  const PreparedTransport transport;
  const LightResponse response;
  Observations reported;  // as (3.6) judges them
  Observations judged;    // as the objective judges them
  LightDistribution distribution;
  LightEstimates clusters;
  LightTree tree;
  double initial_seconds = 0, optimal_seconds = 0, cache_seconds = 0;
  bool lights_may_be_farther = false;  // a larger region was due, and not searched any more

 private:
  void look_where_light_comes_from(StageClock& clock);
  JointSearch joint_search() const;
  // What the lights found leave, in parts of what they were to bring.
  double part_left() const;
  // Of what held-out receivers want: with noise the part of the brightness that is missed, without it the error.
  double missed() const;
  double most_missed() const;
  void see_how_far_held_out_ones_are(const RegionSearch* before, StageClock& clock);
  void share_or_hold_out(const RegionSearch* before, StageClock& clock);
  // goes_on: there were none.
  void look_beside_surfaces(const RegionSearch* before, bool goes_on, StageClock& clock);

  Observations searched_;  // no receiver hides the light of all others
  std::shared_ptr<const ExactIndirect> exact_;
  std::shared_ptr<const HeldOut> held_out_;
  LightEstimates beside_surfaces_;
  JointLights found_;
};

}  // namespace chiaro::inverse

#pragma once
// The main job: the lights that produce a target.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "inverse/solve/observations.h"
#include "inverse/solve/termination.h"
#include "inverse/target/target.h"
#include "inverse/transport/allowed_places.h"
#include "inverse/transport/transport_cache.h"
#include "renderer/core/control.h"
#include "renderer/scene/light.h"

namespace chiaro::inverse {

enum class SolveMethod : std::uint8_t {
  kThesis,  // the published pipeline, step for step
  kJoint,   // its front end, then a joint refinement of all positions and intensities (the default)
};

// The best set of its size that a solve came by.
struct LightSet {
  std::vector<renderer::PointLight> lights;
  double relative_l2 = 0;  // (3.6) over the important vertices, or over others where they were refitted to those
};

struct SolveOptions {
  SolveMethod method = SolveMethod::kJoint;
  Objective objective = Objective::kL2;  // of the joint method
  int important_vertices = 1000;
  double geometry_weight = 1, illumination_weight = 1;  // w1, w2 of eq. (3.2)
  double weak_light = 0.02;                             // w of eq. (3.5)
  std::optional<double> error_threshold;                // of the lightcut, relative L2; absent: from the method
  int max_lights = 32;
  int exact_lights = 0;   // 0: as many as it takes
  double time_limit = 0;  // seconds, beside those of transport, after which nothing further is sought; 0: none
  int verification_samples =
      0;  // paths per receiver of the final, fresh evaluation; 0: as trace_for_verification() chooses
  std::uint64_t seed = 0;
  std::vector<LightSet> earlier;       // of another solve of the same: nothing is searched, they are only refined …
  std::filesystem::path earlier_file;  // … and come from there
  bool keep_stages = false;            // what each stage found, for a report
};

struct FoundLight {
  renderer::Light light;
  double contribution = 0;                      // ‖its illumination‖ / Σ over all found
  Vec3f position_interval, intensity_interval;  // half widths of 90 % intervals: metres, candela (or lux)
};

// A place where the lights found do not produce the target.
struct NotReached {
  std::string node;   // whose surface it is
  Vec3f position;     // where it is worst, metres
  double share = 0;   // of the squared error of all receivers
  double excess = 0;  // Σ luminance found − wanted, cd/m², over its receivers: negative where it is too dark …
  double wanted = 0;  // … and Σ luminance wanted
  bool other_color = false;  // the error is one of colour, hardly of luminance
};

struct StageReport {
  std::string name;
  double seconds = 0;
  std::vector<std::pair<std::string, double>> figures;
};

struct SolveStages;  // report.h

struct SolveResult {
  std::vector<FoundLight> lights;            // brightest contribution first
  double relative_l2 = 0;                    // traced afresh, all receivers, without the noise of that trace
  double relative_l2_cached = 0;             // by the cache
  double initial_relative_l2 = 0;            // by the cache, before the last optimisation
  std::optional<double> verification_noise;  // relative standard error of the fresh evaluation; absent: not known
  double target_noise = 0;                   // relative L2 that the target's own noise should give; 0: not known
  double initial_seconds = 0, optimal_seconds = 0, cache_seconds = 0, total_seconds = 0;
  std::vector<LightSet> error_curve;  // of ever more lights; of the joint method alone
  std::vector<StageReport> stages;
  int important_vertices = 0;
  Termination termination = Termination::kNoFurtherExplainsMore;
  renderer::Box3f region;               // of the grid that lights were sought in; empty where they were in place
  bool lights_may_be_farther = false;   // than the largest region that was searched, and outside the scene
  std::vector<NotReached> not_reached;  // worst first; none where noise explains the error, or nearly so
  std::string advice;                   // what may help there
  std::vector<std::pair<int, int>>
      not_told_apart;               // of lights, by their numbers from 1: of which only the sum is known
  std::vector<Vec3f> illumination;  // of the found lights and the fixed part, traced afresh, per receiver
  std::shared_ptr<const SolveStages> found_by_stages;  // none unless they were to be kept
};

struct SolveProblem {
  const renderer::RayTracer& tracer;
  const Target& target;
  std::optional<std::filesystem::path> cache_file;  // absent: baked here
  LightGridOptions grid;                            // for a bake here
  BakeSettings bake;                                // for a bake here; of a cache file: its materials must agree
  renderer::Lights kept_lights;                     // stay lit, untouched
  PlaceRules places{};                              // where lights may stand; default: anywhere in the grid's region
  IntensityRules intensities{};
  renderer::Lights lights_in_place{};  // not none: these stay where they are, their intensities alone are sought
};

// Error for a target of another scene, a stale cache, a target that no light can produce, or rules that no light can
// keep to ("no light possible"). Rules are never broken. The published method knows none.
SolveResult solve(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control = {});

}  // namespace chiaro::inverse

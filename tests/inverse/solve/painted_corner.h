#pragma once
// Targets of known lights on a small scene.

#include <vector>

#include "inverse/solve/exact_indirect.h"
#include "inverse/solve/important_vertices.h"
#include "inverse/solve/observations.h"
#include "inverse/solve/solve.h"
#include "inverse/transport/bake.h"
#include "renderer/core/sampler.h"
#include "tests/support/code_scenes.h"

namespace chiaro::inverse::tests {

using Eigen::Array3d;
using Eigen::Vector3d;

inline BakeSettings bake_settings(int bounces) {
  BakeSettings settings;
  settings.samples = 64;
  settings.bounces = bounces;
  settings.materials = "gltf";
  return settings;
}

// Lights well inside the corner, apart from each other, of different colours.
inline LightEstimates known_lights(std::size_t count) {
  const LightEstimates all{{{3.1, 2.3, 3.0}, {9, 7, 5}}, {{1.0, 1.2, 2.9}, {2, 5, 9}}, {{2.9, 1.5, 0.8}, {6, 3, 3}}};
  return {all.begin(), all.begin() + std::ptrdiff_t(count)};
}

// corner_with_ball or another scene, its receivers, and what lights of one's choice show on them.
class PaintedCorner {
 public:
  explicit PaintedCorner(float max_edge = 0.2F, renderer::Scene scene = test::corner_with_ball())
      : scene_(std::move(scene)), receivers_(make_receivers(scene_, {.max_edge = max_edge})) {}

  Target target(const LightEstimates& lights, int bounces) const {
    const auto lit = trace_illumination(tracer_, receivers_.samples, point_lights(lights),
                                        {.samples = 256, .bounces = bounces, .seed = 99});
    Target target{receivers_, lit.value, std::vector<float>(receivers_.size(), 1.0F), {}};
    if (bounces != 0) target.standard_error = standard_error_per_receiver(lit);
    return target;
  }

  const renderer::Scene& scene() const { return scene_; }
  const renderer::RayTracer& tracer() const { return tracer_; }
  const Receivers& receivers() const { return receivers_; }
  double diagonal() const { return double(tracer_.bounds().diagonal()); }

 private:
  renderer::Scene scene_;
  renderer::RayTracer tracer_{scene_};
  Receivers receivers_;
};

// Some receivers of the corner or of another scene, direct light only, and what is wanted there.
class DirectProblem {
 public:
  explicit DirectProblem(const LightEstimates& lights, std::size_t count = 250,
                         renderer::Scene scene = test::corner_with_ball())
      : corner_(0.2F, std::move(scene)) {
    const Receivers& all = corner_.receivers();
    const Receivers some = select_receivers(all, evenly_spread(all.size(), count));
    samples_ = some.samples;
    cache_ = bake(corner_.tracer(), some, make_light_grid(corner_.tracer(), {.counts = {6, 5, 6}, .region = {}}),
                  bake_settings(0))
                 .cache;
    response_.emplace(corner_.tracer(), samples_, cache_);
    exact_.emplace(corner_.tracer(), samples_, cache_.settings);
    observations_.wanted = total_illumination(evaluate_columns(*response_, lights, Evaluation::kTracedVisibility),
                                              lights, Eigen::Index(count));
    observations_.sqrt_weight = Eigen::VectorXd::Ones(Eigen::Index(count));
    observations_.stands_for = Eigen::VectorXd::Ones(Eigen::Index(count));
    observations_.target = observations_.wanted;
    observations_.standard_error = Eigen::VectorXd::Zero(Eigen::Index(count));
    observations_.measure_target();
  }

  const renderer::RayTracer& tracer() const { return corner_.tracer(); }
  const LightResponse& response() const { return *response_; }
  const ExactIndirect& exact() const { return *exact_; }
  const Observations& observations() const { return observations_; }
  double diagonal() const { return corner_.diagonal(); }

 private:
  PaintedCorner corner_;
  std::vector<renderer::SurfaceSample> samples_;
  TransportCache cache_;
  std::optional<LightResponse> response_;
  std::optional<ExactIndirect> exact_;
  Observations observations_;
};

// Of receivers, the same each time: up to this much, evenly.
inline Column noise_up_to(double amplitude, int receivers) {
  Column noise(receivers, 3);
  for (Eigen::Index i = 0; i < receivers; ++i) {
    renderer::Sampler sampler(5, 0, std::uint32_t(i));
    for (int c = 0; c < 3; ++c) noise(i, c) = amplitude * (2 * double(sampler.next_1d()) - 1);
  }
  return noise;
}

// The largest distance, metres, from a known light to the nearest of the positions.
inline double farthest_from(const LightEstimates& known, const std::vector<Vector3d>& positions) {
  double farthest = 0;
  for (const LightEstimate& light : known) {
    double nearest = 1e30;
    for (const Vector3d& p : positions) nearest = std::min(nearest, (p - light.position).norm());
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

}  // namespace chiaro::inverse::tests

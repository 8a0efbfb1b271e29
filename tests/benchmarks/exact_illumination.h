#pragma once

#include <vector>

#include "inverse/solve/solve.h"
#include "tests/benchmarks/random_light_sets.h"

namespace chiaro::benchmarks {

// How far found lights are from the true ones, without the noise of paths: direct light of all of a stage's receivers,
// light by bounces of some of them.
class ExactIllumination {
 public:
  // Keeps a reference to the stage.
  explicit ExactIllumination(const Stage& stage);

  // ‖illumination by the lights found − by the true ones‖ / ‖the latter‖
  double error(const std::vector<renderer::PointLight>& truth, const std::vector<inverse::FoundLight>& found) const;

 private:
  struct Illumination {
    std::vector<renderer::Vec3f> direct;    // of all receivers
    std::vector<renderer::Vec3f> indirect;  // of those in `some_`
  };
  Illumination illumination(const std::vector<renderer::PointLight>& lights) const;
  double squared_norm(const Illumination& illumination) const;

  const Stage& stage_;
  std::vector<std::size_t> some_;
  inverse::GatherOperator gather_;
};

}  // namespace chiaro::benchmarks

#pragma once
// Random constraints on lights, tight, contradictory and infeasible ones among them, for benchmarks that check what
// solve makes of them.

#include <string>

#include "inverse/solve/light_constraints.h"
#include "inverse/solve/solve.h"
#include "tests/benchmarks/random_light_sets.h"

namespace chiaro::benchmarks {

struct ConstraintCase {
  std::size_t number = 0;
  inverse::LightConstraints constraints;
  renderer::Lights scene_lights;  // that are kept, or whose positions are
  inverse::SolveMethod method = inverse::SolveMethod::kJoint;
};

ConstraintCase random_case(const Stage& stage, std::uint64_t seed, std::size_t number);

// As a file of constraints has them.
std::string json_of(const inverse::LightConstraints& constraints);

}  // namespace chiaro::benchmarks

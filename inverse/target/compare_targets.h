#pragma once

#include "inverse/target/target.h"

namespace chiaro::inverse {

struct TargetComparison {
  double relative_l2 = 0, rmse = 0, relative_mse = 0, psnr = 0, max_difference = 0;
  Vec3f mean_a, mean_b;
  std::size_t max_at = 0;  // receiver
};

// Figures of `a` against the reference `b`, on the same receivers, each weighted as `b` has it: those of weight 0 do
// not take part. Error where the receivers differ.
TargetComparison compare_targets(const Target& a, const Target& b);

}  // namespace chiaro::inverse

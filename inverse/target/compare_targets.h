#pragma once

#include <array>
#include <string>
#include <vector>

#include "inverse/target/target.h"
#include "renderer/image/compare_images.h"

namespace chiaro::inverse {

// Figures of one surface: a part of the receivers.
struct SurfaceComparison {
  std::string name;
  double relative_l2 = 0, rmse = 0, max_difference = 0;
  Vec3f mean_a, mean_b;
};

struct TargetComparison {
  double relative_l2 = 0, rmse = 0, relative_mse = 0, psnr = 0, max_difference = 0;
  Vec3f mean_a, mean_b;
  std::size_t max_at = 0;  // receiver
  std::array<renderer::ChannelComparison, 3> channels{};
  std::vector<SurfaceComparison> surfaces;  // those that weigh anything, in the order of their parts
};

// Figures of `a` against the reference `b`, on the same receivers, each weighted as `b` has it: those of weight 0 do
// not take part. Error where the receivers differ.
TargetComparison compare_targets(const Target& a, const Target& b);

}  // namespace chiaro::inverse

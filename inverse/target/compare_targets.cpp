#include "inverse/target/compare_targets.h"

#include <algorithm>

#include <fmt/format.h>

#include "renderer/core/error.h"
#include "renderer/image/difference_sums.h"

namespace chiaro::inverse {
namespace {

using renderer::Error;

// The same receivers: every |position a − position b| ≤ this × the diagonal of all. Room for a trip through another
// program's arithmetic, far below the distance of neighbours.
constexpr float kSamePosition = 1e-5F;

void check_same_receivers(const Receivers& a, const Receivers& b) {
  const char* expected = "two targets on the same receivers";
  if (a.size() != b.size()) {
    throw Error({"", "", fmt::format("the targets have {} and {} receivers", a.size(), b.size()), expected});
  }
  renderer::Box3f bounds;
  for (const Vec3f position : b.positions) bounds.extend(position);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const float distance = length(a.positions[i] - b.positions[i]);
    if (distance <= kSamePosition * bounds.diagonal()) continue;
    throw Error(
        {"", fmt::format("receiver {}", i), fmt::format("lies {} m apart in the two targets", distance), expected});
  }
}

// Receivers of weight 0 do not take part.
TargetComparison figures(const Target& a, const Target& b) {
  renderer::DifferenceSums sums;
  TargetComparison result;
  double mean_a[3] = {}, mean_b[3] = {}, total_weight = 0;
  for (std::size_t i = 0; i < a.receivers.size(); ++i) {
    if (b.weight[i] == 0) continue;
    total_weight += b.weight[i];
    for (int c = 0; c < 3; ++c) {
      const double va = a.illumination[i][c], vb = b.illumination[i][c];
      if (sums.add(va, vb, b.weight[i])) result.max_at = i;
      mean_a[c] += b.weight[i] * va;
      mean_b[c] += b.weight[i] * vb;
    }
  }
  if (total_weight == 0) throw Error({"", "", "every weight of the reference is 0", "a weight > 0 somewhere"});
  for (int c = 0; c < 3; ++c) {
    result.mean_a[c] = float(mean_a[c] / total_weight);
    result.mean_b[c] = float(mean_b[c] / total_weight);
  }
  result.rmse = sums.rmse();
  result.relative_mse = sums.relative_mse();
  result.psnr = sums.psnr();
  result.max_difference = sums.max_difference;
  return result;
}

}  // namespace

TargetComparison compare_targets(const Target& a, const Target& b) {
  check_same_receivers(a.receivers, b.receivers);
  TargetComparison result = figures(a, b);
  result.relative_l2 = relative_l2(a.illumination, b.illumination, b.weight);
  return result;
}

}  // namespace chiaro::inverse

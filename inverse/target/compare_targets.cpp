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

// Sums over receivers; those of weight 0 do not take part.
struct TargetSums {
  renderer::DifferenceSums all;
  std::array<renderer::DifferenceSums, 3> channels;
  std::array<double, 3> a{}, b{};
  double weight = 0;
  std::size_t max_at = 0;

  Vec3f mean(const std::array<double, 3>& sum) const {
    return {float(sum[0] / weight), float(sum[1] / weight), float(sum[2] / weight)};
  }
};

TargetSums sums_of(const Target& a, const Target& b, std::size_t first, std::size_t count) {
  TargetSums sums;
  for (std::size_t i = first; i < first + count; ++i) {
    const double weight = b.weight[i];
    if (weight == 0) continue;
    sums.weight += weight;
    for (std::size_t c = 0; c < 3; ++c) {
      const double va = a.illumination[i][int(c)], vb = b.illumination[i][int(c)];
      if (sums.all.add(va, vb, weight)) sums.max_at = i;
      sums.channels[c].add(va, vb, weight);
      sums.a[c] += weight * va;
      sums.b[c] += weight * vb;
    }
  }
  return sums;
}

std::array<renderer::ChannelComparison, 3> channels_of(const TargetSums& sums) {
  std::array<renderer::ChannelComparison, 3> channels;
  for (std::size_t c = 0; c < 3; ++c) {
    const renderer::DifferenceSums& s = sums.channels[c];
    channels[c] = {s.relative_l2(),         s.rmse(),        s.relative_mse(), s.psnr(), sums.a[c] / sums.weight,
                   sums.b[c] / sums.weight, s.max_difference};
  }
  return channels;
}

std::vector<SurfaceComparison> surfaces_of(const Target& a, const Target& b) {
  std::vector<SurfaceComparison> surfaces;
  for (const Receivers::Part& part : b.receivers.parts) {
    const TargetSums sums = sums_of(a, b, part.first_receiver, part.receiver_count);
    if (sums.weight == 0) continue;
    surfaces.push_back({part.name, sums.all.relative_l2(), sums.all.rmse(), sums.all.max_difference, sums.mean(sums.a),
                        sums.mean(sums.b)});
  }
  return surfaces;
}

TargetComparison figures(const Target& a, const Target& b) {
  const TargetSums sums = sums_of(a, b, 0, a.receivers.size());
  if (sums.weight == 0) throw Error({"", "", "every weight of the reference is 0", "a weight > 0 somewhere"});
  TargetComparison result;
  result.mean_a = sums.mean(sums.a);
  result.mean_b = sums.mean(sums.b);
  result.rmse = sums.all.rmse();
  result.relative_mse = sums.all.relative_mse();
  result.psnr = sums.all.psnr();
  result.max_difference = sums.all.max_difference;
  result.max_at = sums.max_at;
  result.channels = channels_of(sums);
  result.surfaces = surfaces_of(a, b);
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

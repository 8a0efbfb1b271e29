#include "inverse/solve/pooled_errors.h"

#include <array>
#include <cmath>

#include "inverse/transport/sample_tree.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

constexpr std::size_t kNeighbours = 16;  // with the receiver: about 7 % of uncertainty of what 4 batches tell

SampleTree tree_of(const std::vector<renderer::SurfaceSample>& samples) {
  renderer::Box3f box;
  for (const renderer::SurfaceSample& sample : samples) box.extend(sample.position);
  return {samples, typical_spacing(box, samples.size())};
}

}  // namespace

std::vector<float> pooled_standard_errors(const Target& target, const std::vector<std::size_t>& chosen) {
  if (target.standard_error.empty()) return {};
  const SampleTree tree = tree_of(target.receivers.samples);
  std::vector<float> pooled(chosen.size());
  renderer::parallel_for(chosen.size(), [&](std::size_t k) {
    std::array<std::uint32_t, kNeighbours> near{};
    const std::size_t count = tree.find_nearest(target.receivers.samples[chosen[k]], near);
    double sum = 0;
    std::size_t others = 0;
    for (std::size_t n = 0; n < count; ++n) {
      if (near[n] == chosen[k] || !(target.weight[near[n]] > 0)) continue;
      sum += std::pow(double(target.standard_error[near[n]]), 2);
      ++others;
    }
    pooled[k] = others > 0 ? float(std::sqrt(sum / double(others))) : target.standard_error[chosen[k]];
  });
  return pooled;
}

}  // namespace chiaro::inverse

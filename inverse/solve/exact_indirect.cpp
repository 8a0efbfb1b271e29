#include "inverse/solve/exact_indirect.h"

namespace chiaro::inverse {
namespace {

constexpr int kSamplesFactor = 4;     // gather rays per receiver, over those of the bake
constexpr int kPointsPerSample = 16;  // gather points over rays

GatherOptions gather_options(const BakeSettings& settings) {
  return {.samples = kSamplesFactor * settings.samples,
          .points_per_sample = kPointsPerSample,
          .bounces = settings.bounces,
          .seed = settings.seed};
}

}  // namespace

ExactIndirect::ExactIndirect(const renderer::RayTracer& tracer, const std::vector<renderer::SurfaceSample>& receivers,
                             const BakeSettings& settings)
    : tracer_(tracer), gather_(make_gather_operator(tracer, receivers, gather_options(settings))) {}

void ExactIndirect::correct(const LightResponse& response, LightEstimates& lights) const {
  for (std::size_t first = 0; first < lights.size(); first += kLightBlock) {
    const std::size_t count = std::min<std::size_t>(kLightBlock, lights.size() - first);
    std::vector<Vec3f> positions;
    for (std::size_t l = 0; l < count; ++l) {
      const Eigen::Vector3d& p = lights[first + l].position;
      positions.push_back({float(p.x()), float(p.y()), float(p.z())});
    }
    const std::vector<LightBlock> exact = indirect_illumination(tracer_, gather_, positions);
    for (std::size_t l = 0; l < count; ++l) {
      LightEstimate& light = lights[first + l];
      light.correction = -response.interpolated_indirect(light.position);
      for (std::size_t i = 0; i < exact.size(); ++i) {
        for (int c = 0; c < 3 && !light.direct_only; ++c) {
          light.correction(Eigen::Index(i), c) += double(exact[i].channel[c][l]);
        }
      }
    }
  }
}

}  // namespace chiaro::inverse

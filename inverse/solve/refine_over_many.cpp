#include "inverse/solve/refine_over_many.h"

#include <algorithm>

#include "inverse/solve/instrumental_fit.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

constexpr int kRounds = 5;
constexpr double kNear = 2e-3;                     // of the region's diagonal: indirect light hardly changes
constexpr std::size_t kPathsPerSample = 2000;      // of all receivers together, over rays per receiver of the bake
constexpr int kLeastPaths = 4, kMostPaths = 8192;  // per receiver

// The light that comes by bounces where the lights stand now. It is path traced, and noisy.
struct TracedIndirect {
  std::vector<Column> unity;  // of each light of 1 cd
  Column others;              // all light of the others, their direct light too
};

TracedIndirect trace_indirect(const ManyReceivers& many, const LightEstimates& lights, const LightEstimates& others) {
  renderer::Lights all;
  for (const LightEstimates* some : {&lights, &others}) {
    for (const LightEstimate& estimate : *some) all.emplace_back(point_light(estimate));
  }
  const std::vector<renderer::SurfaceSample>& at = many.response.receivers();
  const std::size_t paths = kPathsPerSample * std::size_t(many.settings.samples) / at.size();
  const renderer::TraceOptions trace{std::clamp(int(paths), kLeastPaths, kMostPaths), many.settings.bounces,
                                     many.settings.seed, false};
  const auto traced = trace_illumination_by_light(many.tracer, at, all, trace, many.control).of_light;
  TracedIndirect indirect{{}, Column::Zero(Eigen::Index(at.size()), 3)};
  for (std::size_t j = 0; j < lights.size(); ++j) {
    const Column direct = many.response.direct(lights[j].position);
    indirect.unity.push_back(unity_indirect(column_of(traced[j]), direct, lights[j].intensity));
  }
  for (std::size_t l = lights.size(); l < all.size(); ++l) indirect.others += column_of(traced[l]);
  return indirect;
}

// A light whose indirect light stayed behind while it moved is led past its place in one round and back in the next.
// The ratio of both moves tells where it would come to rest (Aitken's Δ²).
// earlier: before the round before; empty in the first.
void come_to_rest(const AllowedPlaces& places, const LightEstimates& earlier, const LightEstimates& before,
                  LightEstimates& lights) {
  for (std::size_t j = 0; j < earlier.size(); ++j) {
    const Eigen::Vector3d last_move = before[j].position - earlier[j].position;
    const Eigen::Vector3d move = lights[j].position - before[j].position;
    const double ratio = move.dot(last_move) / std::max(last_move.squaredNorm(), 1e-300);
    if (!(ratio < 0 && ratio > -1)) continue;
    const Eigen::Vector3d at_rest = before[j].position + move / (1 - ratio);
    lights[j].position = places.nearest(at_rest).value_or(lights[j].position);
  }
}

// With indirect light as it is where the lights stand when it begins.
void refine_once(const ManyReceivers& many, const LightEstimates& others, PolishedLights& refined) {
  const TracedIndirect indirect = trace_indirect(many, refined.lights, others);
  Observations observations = many.observations;
  observations.wanted -= indirect.others;
  descend_with_instruments(many.response, observations, indirect.unity, refined.lights);
  refined.error = fit_intensities_with_instruments(many.response, observations, indirect.unity, refined.lights);
  ++refined.rounds;
}

}  // namespace

PolishedLights refine_over_many(const ManyReceivers& many, const LightEstimates& start, const LightEstimates& others) {
  PolishedLights refined;
  for (const LightEstimate& light : start) refined.lights.push_back({light.position, light.intensity});
  if (start.empty() || many.response.receiver_count() == 0) return refined;
  const double near = kNear * double(many.response.grid().region.diagonal());
  double move = std::numeric_limits<double>::infinity();
  LightEstimates earlier;
  while (move > near && refined.rounds < kRounds) {
    const LightEstimates before = refined.lights;
    refine_once(many, others, refined);
    come_to_rest(many.response.places(), earlier, before, refined.lights);
    move = largest_move(refined.lights, before);
    earlier = before;
  }
  return refined;
}

}  // namespace chiaro::inverse

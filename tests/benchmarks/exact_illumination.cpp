#include "tests/benchmarks/exact_illumination.h"

#include <algorithm>
#include <cmath>

#include "inverse/transport/direct_light.h"
#include "inverse/transport/gather_operator.h"
#include "renderer/core/fork_join.h"

namespace chiaro::benchmarks {
namespace {

using renderer::PointLight;
using renderer::Vec3f;

constexpr std::size_t kSome = 4000;  // receivers

std::vector<Vec3f> difference(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  std::vector<Vec3f> difference(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) difference[i] = a[i] - b[i];
  return difference;
}

}  // namespace

ExactIllumination::ExactIllumination(const Stage& stage)
    : stage_(stage),
      some_(inverse::evenly_spread(stage.receivers.size(), kSome)),
      gather_(
          inverse::make_gather_operator(stage.tracer, inverse::select_receivers(stage.receivers, some_).samples, {})) {}

double ExactIllumination::error(const std::vector<PointLight>& truth,
                                const std::vector<inverse::FoundLight>& found) const {
  std::vector<PointLight> lights;
  for (const inverse::FoundLight& light : found) lights.push_back(std::get<renderer::PointLight>(light.light));
  const Illumination wanted = illumination(truth), got = illumination(lights);
  const Illumination off{difference(got.direct, wanted.direct), difference(got.indirect, wanted.indirect)};
  return std::sqrt(squared_norm(off) / squared_norm(wanted));
}

// Of all receivers: direct light's of all, and what indirect light makes of it where it is known.
double ExactIllumination::squared_norm(const Illumination& illumination) const {
  double direct = 0, by_bounces = 0;
  for (const Vec3f& value : illumination.direct) direct += double(length_squared(value));
  for (std::size_t k = 0; k < some_.size(); ++k) {
    const Vec3f& without = illumination.direct[some_[k]];
    by_bounces += double(length_squared(without + illumination.indirect[k])) - double(length_squared(without));
  }
  return std::max(0.0, direct + by_bounces * double(illumination.direct.size()) / double(some_.size()));
}

ExactIllumination::Illumination ExactIllumination::illumination(const std::vector<PointLight>& lights) const {
  const std::vector<renderer::SurfaceSample>& samples = stage_.receivers.samples;
  Illumination sum{std::vector<Vec3f>(samples.size()), std::vector<Vec3f>(some_.size())};
  std::vector<Vec3f> positions;
  for (const PointLight& light : lights) positions.push_back(light.position);
  renderer::parallel_for(samples.size(), [&](std::size_t i) {
    for (const PointLight& light : lights) {
      const float visible = inverse::visible_part(stage_.tracer, samples[i], light.position);
      sum.direct[i] += visible * inverse::unoccluded_illumination(samples[i], light.position) * light.intensity;
    }
  });
  const auto indirect = inverse::indirect_illumination_by_light(stage_.tracer, gather_, positions);
  for (std::size_t j = 0; j < lights.size(); ++j) {
    for (std::size_t k = 0; k < some_.size(); ++k) sum.indirect[k] += lights[j].intensity * indirect[j][k];
  }
  return sum;
}

}  // namespace chiaro::benchmarks

#include "cli/illumination_base.h"

#include <algorithm>

namespace chiaro::cli {

using renderer::Vec3f;

TracedTarget trace_target(const renderer::RayTracer& tracer, inverse::Receivers receivers,
                          const renderer::Lights& lights, const renderer::TraceOptions& options,
                          const renderer::Control& control) {
  renderer::Illumination illumination =
      renderer::trace_illumination(tracer, receivers.samples, lights, options, control);
  TracedTarget traced;
  traced.relative_standard_error = renderer::relative_standard_error(illumination);
  traced.target = black_target(std::move(receivers));
  traced.target.standard_error = inverse::standard_error_per_receiver(illumination);
  traced.target.illumination = std::move(illumination.value);
  return traced;
}

inverse::Target black_target(inverse::Receivers receivers) {
  inverse::Target target;
  target.illumination.assign(receivers.size(), Vec3f{});
  target.weight.assign(receivers.size(), 1.0F);
  target.receivers = std::move(receivers);
  return target;
}

bool is_black(const inverse::Target& target) {
  return std::all_of(target.illumination.begin(), target.illumination.end(),
                     [](Vec3f value) { return renderer::max_component(value) <= 0; });
}

Vec3f mean_illumination(const inverse::Target& target) {
  double sums[3] = {};
  for (const Vec3f value : target.illumination) {
    for (int c = 0; c < 3; ++c) sums[c] += double(value[c]);
  }
  const double count = double(std::max<std::size_t>(1, target.illumination.size()));
  return {float(sums[0] / count), float(sums[1] / count), float(sums[2] / count)};
}

}  // namespace chiaro::cli

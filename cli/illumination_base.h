#pragma once
// Illumination under given lights as a target: what `illuminate` writes and `paint` starts from.

#include <optional>

#include "inverse/target/target.h"
#include "renderer/core/control.h"
#include "renderer/trace/trace_illumination.h"

namespace chiaro::cli {

struct TracedTarget {
  inverse::Target target;
  std::optional<double> relative_standard_error;  // absent: not known
};

TracedTarget trace_target(const renderer::RayTracer& tracer, inverse::Receivers receivers,
                          const renderer::Lights& lights, const renderer::TraceOptions& options,
                          const renderer::Control& control);

// Zero everywhere, weight 1.
inverse::Target black_target(inverse::Receivers receivers);

bool is_black(const inverse::Target& target);

// cd/m², over the receivers.
renderer::Vec3f mean_illumination(const inverse::Target& target);

}  // namespace chiaro::cli

#include "inverse/solve/check_brightness.h"

#include <fmt/format.h>

#include "renderer/core/error.h"
#include "renderer/core/world_limits.h"

namespace chiaro::inverse {

void check_brightness(const SolveProblem& problem, double brightest) {
  if (brightest <= double(renderer::kBrightest)) return;
  throw renderer::Error({problem.tracer.scene().path, "solve",
                         fmt::format("no light possible: it takes a light of {:.3g} cd or lux", brightest),
                         fmt::format("at most {:g}: a dimmer target, or --max-intensity", renderer::kBrightest)});
}

}  // namespace chiaro::inverse

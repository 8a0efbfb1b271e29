#include "inverse/solve/prepare_transport.h"

#include <fmt/format.h>

#include "inverse/transport/bake.h"
#include "inverse/transport/direct_light.h"
#include "inverse/transport/grid_by_error.h"
#include "renderer/core/error.h"

namespace chiaro::inverse {

using renderer::Error;

namespace {

std::string text_of_bounces(int bounces) { return bounces < 0 ? "all bounces" : fmt::format("{} bounces", bounces); }

// A cache knows what is seen from beside the vertices. Of receivers that have moved to where pictures show them that is
// found anew; of light by bounces there is little that changes on the way.
void look_from_samples(const SolveProblem& problem, const std::vector<std::size_t>& chosen,
                       const renderer::Control& control, TransportCache& cache) {
  renderer::parallel_for(cache.grid.positions.size(), "cache", control, [&](std::size_t light) {
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      const renderer::SurfaceSample& at = problem.target.receivers.samples[chosen[k]];
      const auto seed = std::uint32_t(light * chosen.size() + k);
      const bool seen = sees(problem.tracer, at, cache.grid.positions[light], seed);
      cache.visibility[light * chosen.size() + k] = seen ? 1 : 0;
    }
  });
}

}  // namespace

void require_fitting_cache(const SolveProblem& problem) {
  if (!problem.cache_file) return;
  const std::string file = problem.cache_file->string();
  const TransportCache header = load_transport_cache_header(*problem.cache_file);
  if (header.settings.materials != problem.bake.materials) {
    throw Error({file, "header", fmt::format("stale cache: baked with materials \"{}\"", header.settings.materials),
                 fmt::format("\"{}\"", problem.bake.materials)});
  }
  if (header.scene_fingerprint != renderer::fingerprint(problem.tracer.scene())) {
    throw Error({file, "header", "stale cache: baked for another scene, or the scene has changed since",
                 "a cache of " + problem.tracer.scene().path + ": bake again"});
  }
  if (header.receiver_fingerprint != fingerprint(problem.target.receivers)) {
    throw Error({file, "header", "stale cache: baked for other receivers than the target's",
                 "a cache baked with --on the target, or with the --on or --max-edge that it was painted with"});
  }
  if (header.settings.bounces != problem.bake.bounces) {
    throw Error({file, "header", fmt::format("stale cache: baked with {}", text_of_bounces(header.settings.bounces)),
                 fmt::format("{}, as --bounces says", text_of_bounces(problem.bake.bounces))});
  }
}

void require_free_space(const SolveProblem& problem, const renderer::Control& control) {
  const bool by_parts = !problem.places.boxes.empty() || !problem.places.mounts.empty();
  if (!problem.cache_file || !by_parts) return;
  make_light_grid(problem.tracer, around_places({}, problem.tracer.scene(), problem.places), control);
}

PreparedTransport prepare_transport(const SolveProblem& problem, const std::vector<std::size_t>& chosen,
                                    const renderer::Control& control) {
  require_fitting_cache(problem);
  if (problem.cache_file) {
    TransportCache cache = load_transport_cache(*problem.cache_file, chosen);
    if (problem.target.receivers.samples_moved) look_from_samples(problem, chosen, control.without_progress(), cache);
    return {std::move(cache)};
  }
  const LightGrid grid =
      choose_light_grid(problem.tracer, problem.target.receivers, problem.grid, problem.bake, control);
  return {bake(problem.tracer, select_receivers(problem.target.receivers, chosen), grid, problem.bake, control).cache};
}

}  // namespace chiaro::inverse

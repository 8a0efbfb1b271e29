#pragma once
// Whether lights keep to constraints, without what the solver checks it by: by trying all triangles, colours and pairs.

#include <string>
#include <vector>

#include "inverse/solve/light_constraints.h"
#include "inverse/solve/solve.h"
#include "renderer/trace/ray_tracer.h"

namespace chiaro::benchmarks {

struct Violation {
  std::string kind, what;
};

// scene_lights: those that are kept, or whose positions are.
std::vector<Violation> violations(const renderer::Scene& scene, const inverse::LightConstraints& constraints,
                                  const renderer::Lights& scene_lights, const std::vector<inverse::FoundLight>& found);

// Whether a random search finds places for as many lights as asked for (1 if not), in free space.
bool places_exist(const renderer::RayTracer& tracer, const inverse::LightConstraints& constraints,
                  const renderer::Lights& scene_lights, std::uint64_t seed);

}  // namespace chiaro::benchmarks

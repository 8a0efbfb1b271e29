#pragma once

#include <vector>

#include "inverse/target/target.h"
#include "renderer/trace/ray_tracer.h"

namespace chiaro::inverse {

struct ImportanceOptions {
  int count = 1000;
  double geometry_weight = 1, illumination_weight = 1;  // w1, w2
  std::uint64_t seed = 0;
};

// Per receiver, eq. (3.2): Importance = w1 Geo + w2 Illumi, each normalised to 0 … 1.
struct Importance {
  std::vector<double> geometry;      // eq. (3.3): scene diagonal − harmonic mean of ray distances
  std::vector<double> illumination;  // eq. (3.4): |cotangent Laplacian of the HSV value of Ψ|
  std::vector<double> total;         // 0 where the target's weight is 0
  std::vector<std::size_t> chosen;   // the important vertices, ascending
  std::vector<double> probability;   // with which each of them was to be chosen
};

// Drawn without replacement with `total` as the density, after the few that hold most of the target's energy; all
// vertices of positive weight where there are fewer than count.
Importance choose_important_vertices(const renderer::RayTracer& tracer, const Target& target,
                                     const ImportanceOptions& options);

// Of the same importance, by another draw.
Importance choose_again(Importance importance, const Target& target, std::size_t most, std::uint64_t seed);

}  // namespace chiaro::inverse

#pragma once
// The bright spot that a light makes on a surface close to it. Few of a receiver's rays meet it, so that what it throws
// on receivers is noisy where it outshines all else. Rays from the light find it as well: their ends are connected with
// the receivers, and both ways of finding it are weighted against each other by the balance heuristic. By them also
// comes what the spot's material does other than Lambert's.
//
// Source: Veach, Robust Monte Carlo Methods for Light Transport Simulation, 1997 (eq. 9.8; ch. 10), with the gather
// points' cells in place of the points that densities are taken at.

#include "inverse/transport/gather_operator.h"

namespace chiaro::inverse {

// What the connections change of the indirect illumination of the operator's receivers under a unity light. `direct`:
// of each gather point, by that light.
std::vector<renderer::Vec3f> change_by_bright_spot(const renderer::RayTracer& tracer, const GatherOperator& gather,
                                                   renderer::Vec3f light, std::span<const float> direct);

}  // namespace chiaro::inverse

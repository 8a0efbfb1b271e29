#pragma once
// Where the illumination of receivers is sampled: just inside one of the vertex's faces and in front of it, so that
// receivers on edges, in corners and under furniture neither leak nor blacken.

#include "inverse/transport/receivers.h"
#include "renderer/trace/ray_tracer.h"

namespace chiaro::inverse {

// In front of their faces by what rounding calls for if the scene's triangles below them are no larger than the parts.
void place_samples(Receivers& receivers);

// In front of the scene's triangles below them by the rounding that rays meet those with, whatever part of them the
// receivers cover. Receivers that lie on none are left as they are.
void place_samples_on(const renderer::RayTracer& tracer, Receivers& receivers);

// The number of the largest face of every vertex; ~0: it has none.
std::vector<std::uint32_t> largest_face_per_vertex(const Receivers& receivers);
// Zero for a triangle without area.
Vec3f face_normal(const Receivers& receivers, const renderer::Triangle& face);

}  // namespace chiaro::inverse

#pragma once
// Illumination at surface points by unbiased path tracing: the reference for all that inverse lighting computes.

#include <optional>
#include <span>
#include <vector>

#include "renderer/core/control.h"
#include "renderer/scene/light.h"
#include "renderer/trace/ray_tracer.h"
#include "renderer/trace/trace_options.h"

namespace chiaro::renderer {

// A point on its surface, seen from the side of the normal. Better just in front of it, by what rounding may take it
// off the surface that rays meet: who made it knows the surface's size.
struct SurfaceSample {
  Vec3f position;
  Vec3f normal;         // unit; shading normal: the cosine is taken with it
  float stand_off = 0;  // metres that the position is in front of its surface

  // Where light falls.
  Vec3f on_surface() const { return position - stand_off * normal; }
};

struct Illumination {
  std::vector<Vec3f> value;           // cd/m²: irradiance / π, all bounces, the surface's own albedo left out
  std::vector<Vec3f> standard_error;  // cd/m², of each value; empty: not known, as a single path does not tell
};

// Illumination of each point under `lights` and the scene's emissive surfaces. Same result for any number of threads.
Illumination trace_illumination(const RayTracer& tracer, std::span<const SurfaceSample> points, const Lights& lights,
                                const TraceOptions& options, const Control& control = {});

struct IlluminationByLight {
  Illumination total;                        // with what emissive surfaces bring
  std::vector<std::vector<Vec3f>> of_light;  // [l][i]: what light l brings to point i
};

// The same, also taken apart.
IlluminationByLight trace_illumination_by_light(const RayTracer& tracer, std::span<const SurfaceSample> points,
                                                const Lights& lights, const TraceOptions& options,
                                                const Control& control = {});

// Two independent traces of the same points together, of so many samples each. Where the error of one is not known it
// is taken from that of the other.
Illumination joined(Illumination first, int first_samples, const Illumination& second, int second_samples);

// How many samples it takes until `noise` of so many has come down to `may_be`: no fewer, and `most` at most.
int samples_for_noise(int samples, double noise, double may_be, int most);

// sqrt(Σ weight · standard_error² / Σ weight · value²): the relative L2 distance that noise alone is expected to give,
// if it is known. weight: per point, ≥ 0; empty: all count the same.
std::optional<double> relative_standard_error(const Illumination& illumination, std::span<const float> weight = {});

}  // namespace chiaro::renderer

#pragma once
// Indirect transport that does not know where the light is.
//
//   g        gather points: surface points that the receivers' light paths reach
//   D        direct illumination at the gather points under one light
//   K_gg     their illumination by each other, one bounce: albedo-weighted shares of the hemisphere
//   K_rg     the receivers' illumination by the gather points
//
//   indirect = K_rg (D + K_gg D + K_gg² D + …)
//
// Rays from receivers and gather points go to the nearest gather point of like orientation that is seen from the spot
// that they hit, with the albedo of that very spot. A light close to a gather point is averaged over the point's cell:
// over samples of the surface for which it stands. Surfaces count as Lambertian with their hemispherical albedo. The
// bias of both shrinks with `samples` (more gather points), or is the material's; a bake measures it against the path
// tracer. Source: Hašan, Pellacini, Bala, Direct-to-Indirect Transfer for Cinematic Relighting, 2006.

#include <memory>
#include <vector>

#include "inverse/transport/direct_light.h"
#include "inverse/transport/interreflection.h"
#include "renderer/core/control.h"
#include "renderer/trace/trace_illumination.h"

namespace chiaro::inverse {

class NearestGatherPoint;

struct GatherOperator {
  std::vector<renderer::SurfaceSample> points;
  // Samples of the cell of point i: cell_samples[cell_start[i]] … cell_samples[cell_start[i + 1] − 1].
  std::vector<std::size_t> cell_start;
  std::vector<renderer::SurfaceSample> cell_samples;
  std::vector<float> cell_radius;                  // metres, root mean square over the cell
  Interreflection interreflection;                 // K_gg
  SparseTransport receiver_from_point;             // K_rg; without rows where they are traced in parts
  std::vector<renderer::SurfaceSample> receivers;  // of these rows
  int rays_per_receiver = 0;
  std::shared_ptr<const NearestGatherPoint> nearest;
  int bounces = -1;  // as TraceOptions
  std::size_t ray_count = 0;
};

struct GatherOptions {
  int samples = 256;           // rays per receiver
  int points_per_sample = 32;  // gather points = samples × this, and more where much is hidden
  int paths_per_point = 32;    // traced from the receivers, whose ends are samples of the cells
  int rays_per_point = 64;     // from gather points to each other
  int bounces = -1;
  std::uint64_t seed = 0;
};

// About how many bytes making gather points takes on the way.
double bytes_to_make_gather_points(const GatherOptions& options);

// All but K_rg.
GatherOperator make_gather_points(const renderer::RayTracer& tracer, std::span<const renderer::SurfaceSample> receivers,
                                  const GatherOptions& options, const renderer::Control& control = {});

// Rows of K_rg: those of receivers[chosen[0]], receivers[chosen[1]] …
SparseTransport trace_receiver_rows(const renderer::RayTracer& tracer, const GatherOperator& gather,
                                    std::span<const renderer::SurfaceSample> receivers,
                                    std::span<const std::size_t> chosen, const GatherOptions& options,
                                    const renderer::Control& control = {});

GatherOperator make_gather_operator(const renderer::RayTracer& tracer,
                                    std::span<const renderer::SurfaceSample> receivers, const GatherOptions& options,
                                    const renderer::Control& control = {});

// Illumination of the gather points over all bounces, D + K_gg D + K_gg² D + …, under up to kLightBlock unity lights (1
// cd per channel). control: to be interrupted.
std::vector<LightBlock> illumination_of_gather_points(const renderer::RayTracer& tracer, const GatherOperator& gather,
                                                      std::span<const renderer::Vec3f> lights,
                                                      const renderer::Control& control = {});

// Indirect illumination of all receivers under up to kLightBlock unity lights.
std::vector<LightBlock> indirect_illumination(const renderer::RayTracer& tracer, const GatherOperator& gather,
                                              std::span<const renderer::Vec3f> lights);

// The same of any number of lights, by light and receiver, with what the lights' own rays find of the spots close to
// them (bright_spot.h). control: to be interrupted.
std::vector<std::vector<renderer::Vec3f>> indirect_illumination_by_light(const renderer::RayTracer& tracer,
                                                                         const GatherOperator& gather,
                                                                         std::span<const renderer::Vec3f> lights,
                                                                         const renderer::Control& control = {});

// Indirect illumination of all receivers under one unity light of any kind, for a shadow ray per gather point and
// little else.
std::vector<OneLight> indirect_illumination(const renderer::RayTracer& tracer, const GatherOperator& gather,
                                            const UnityLight& light);

// The same in lane 0; lanes 1, 2, 3: its derivative by the light's x, y, z (per metre) where no shadow edge moves.
std::vector<LightQuad> indirect_illumination_with_gradient(const renderer::RayTracer& tracer,
                                                           const GatherOperator& gather, const UnityLight& light);

// The adjoint: what each gather point gives to up to kLightBlock of the receivers, over all bounces, per direct
// illumination of 1 that falls on it. One block per gather point; lane l belongs to receivers[l].
std::vector<LightBlock> importance_of_gather_points(const GatherOperator& gather,
                                                    std::span<const std::size_t> receivers);

// Indirect illumination of these receivers under one unity light: as indirect_illumination, for a shadow ray per gather
// point and little else.
std::vector<renderer::Vec3f> indirect_illumination_at(const renderer::RayTracer& tracer, const GatherOperator& gather,
                                                      std::span<const LightBlock> importance,
                                                      std::size_t receiver_count, renderer::Vec3f light);

}  // namespace chiaro::inverse

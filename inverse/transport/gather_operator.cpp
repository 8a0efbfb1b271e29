#include "inverse/transport/gather_operator.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "inverse/transport/bright_spot.h"
#include "inverse/transport/eigen_vectors.h"
#include "inverse/transport/gather_cells.h"
#include "inverse/transport/nearest_gather_point.h"
#include "renderer/core/sampler.h"
#include "renderer/trace/bsdf.h"

namespace chiaro::inverse {

using renderer::RayTracer;
using renderer::Sampler;
using renderer::SurfacePoint;
using renderer::SurfaceSample;
using renderer::Vec3f;

namespace {

constexpr int kPathLength = 4;            // surfaces that a path leaves gather points on
constexpr float kNearField = 8.0F;        // cell radii
constexpr std::size_t kEnoughToTell = 8;  // hits

struct GatherHit {
  SurfaceSample at;
  Vec3f albedo;
};

std::optional<GatherHit> gather(const RayTracer& tracer, const SurfaceSample& from, Sampler& sampler) {
  const Vec3f local = renderer::sample_cosine_hemisphere(sampler.next_2d());
  const Vec3f direction = normalize(renderer::Frame3f(from.normal).world_from_local(local));
  renderer::Ray ray{renderer::offset_point(from.position, from.normal), direction, 0, renderer::kInfinity,
                    sampler.next_bits()};
  ray.clear = renderer::ClearSurfaces::kPassByChance;
  const auto hit = tracer.intersect(ray);
  if (!hit) return std::nullopt;
  const SurfacePoint point = make_surface_point(tracer.scene(), ray, *hit);
  const Vec3f in_front = renderer::offset_point(point.position, point.geometric_normal, point.rounding);
  return GatherHit{{in_front, point.shading_normal, point.rounding}, hemispherical_albedo(point)};
}

std::vector<SurfaceSample> trace_gather_path(const RayTracer& tracer, SurfaceSample from, Sampler sampler) {
  std::vector<SurfaceSample> path;
  for (int vertex = 0; vertex < kPathLength; ++vertex) {
    const auto hit = gather(tracer, from, sampler);
    if (!hit) break;
    path.push_back(hit->at);
    if (!(sampler.next_1d() < max_component(hit->albedo))) break;
    from = hit->at;
  }
  return path;
}

// Surface points by importance: where paths from the receivers go.
std::vector<SurfaceSample> trace_gather_paths(const RayTracer& tracer, std::span<const SurfaceSample> receivers,
                                              std::size_t count, std::uint64_t seed, const renderer::Control& control) {
  std::vector<std::vector<SurfaceSample>> paths(count);
  renderer::parallel_for(count, "", control.without_progress(), [&](std::size_t i) {
    const std::size_t receiver = i * receivers.size() / count;
    paths[i] = trace_gather_path(tracer, receivers[receiver], Sampler(seed, 0, std::uint32_t(i)));
  });
  std::vector<SurfaceSample> all;
  for (const auto& path : paths) all.insert(all.end(), path.begin(), path.end());
  return all;
}

std::vector<std::size_t> all_of(std::size_t count) {
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

std::vector<GatherHit> gather_hits(const RayTracer& tracer, const SurfaceSample& from, std::size_t index, int rays,
                                   std::uint64_t seed) {
  std::vector<GatherHit> hits;
  for (int k = 0; k < rays; ++k) {
    Sampler sampler(seed, std::uint32_t(index), std::uint32_t(k));
    if (const auto hit = gather(tracer, from, sampler)) hits.push_back(*hit);
  }
  return hits;
}

// Each hit is as bright as the gather point that it sees; those that see none are as bright as the others. Where there
// are no others they are dark, being hidden from all that lights reach, or if they are too few to tell as bright as the
// nearest gather point.
std::vector<SparseTransport::Entry> row_of(const std::vector<GatherHit>& hits, int rays,
                                           const NearestGatherPoint& nearest) {
  std::vector<SparseTransport::Entry> row;
  Vec3f hidden_albedo{};
  for (const GatherHit& hit : hits) {
    if (const auto point = nearest.find_seen(hit.at)) {
      row.push_back({*point, hit.albedo / float(rays)});
    } else {
      hidden_albedo += hit.albedo / float(rays);
    }
  }
  for (auto& entry : row) entry.weight += hidden_albedo / float(row.size());
  if (!row.empty() || hits.size() >= kEnoughToTell) return row;
  for (const GatherHit& hit : hits) row.push_back({nearest.find_nearest(hit.at), hit.albedo / float(rays)});
  return row;
}

SparseTransport trace_rows(const RayTracer& tracer, std::span<const SurfaceSample> from,
                           std::span<const std::size_t> chosen, int rays, std::uint64_t seed,
                           const NearestGatherPoint& nearest, const renderer::Control& control) {
  std::vector<std::vector<SparseTransport::Entry>> rows(chosen.size());
  constexpr std::size_t kBlock = 32;
  renderer::parallel_for((chosen.size() + kBlock - 1) / kBlock, "gather", control, [&](std::size_t block) {
    for (std::size_t i = block * kBlock; i < std::min(chosen.size(), (block + 1) * kBlock); ++i) {
      control.stop_if_requested();
      rows[i] = row_of(gather_hits(tracer, from[chosen[i]], chosen[i], rays, seed), rays, nearest);
    }
  });
  return SparseTransport::from_rows(std::move(rows));
}

float direct_at(const RayTracer& tracer, const SurfaceSample& at, Vec3f light) {
  const float value = unoccluded_illumination(at, light);
  return value > 0 ? value * visible_part(tracer, at, light) : 0;
}

// That over which light from there is averaged: a gather point, or all of its cell where the light is close.
std::span<const SurfaceSample> samples_towards(const GatherOperator& gather, std::size_t i, Vec3f light) {
  const SurfaceSample& point = gather.points[i];
  const float near = kNearField * gather.cell_radius[i];
  if (length_squared(light - point.position) > near * near) return {&point, 1};
  return {gather.cell_samples.data() + gather.cell_start[i], gather.cell_start[i + 1] - gather.cell_start[i]};
}

float direct_at_gather_point(const RayTracer& tracer, const GatherOperator& gather, std::size_t i, Vec3f light) {
  const auto samples = samples_towards(gather, i, light);
  float sum = 0;
  for (const SurfaceSample& at : samples) sum += direct_at(tracer, at, light);
  return sum / float(samples.size());
}

DirectTerm direct_term_at_gather_point(const RayTracer& tracer, const GatherOperator& gather, std::size_t i,
                                       const UnityLight& light) {
  const Vec3f position = to_vec3f(light.position);
  const auto samples = samples_towards(gather, i, position);
  DirectTerm sum;
  for (const SurfaceSample& at : samples) {
    const DirectTerm term = unoccluded_term(at, light);
    const double visible = term.value > 0 ? double(visible_part(tracer, at, position)) : 0;
    sum.value += visible * term.value;
    sum.gradient += visible * term.gradient;
  }
  return {sum.value / double(samples.size()), sum.gradient / double(samples.size())};
}

// The receivers' light from the gather points' direct light.
template <class Lanes>
std::vector<Lanes> from_gather_points(const GatherOperator& gather, const std::vector<Lanes>& direct,
                                      const renderer::Control& control = {}) {
  std::vector<Lanes> result(gather.receiver_from_point.row_count());
  if (direct.empty()) return result;
  multiply(gather.receiver_from_point, sum_of_bounces(gather.interreflection, direct, gather.bounces, control), result);
  return result;
}

// A quad takes a third of the time of a block.
std::size_t lights_at_once(std::size_t count) {
  constexpr std::size_t kQuad = LightQuad::kLanes;
  return std::min<std::size_t>(count, count <= 2 * kQuad ? kQuad : kLightBlock);
}

// In parallel: body(first, last) for parts of 0 … count − 1.
template <class Body>
void for_each_chunk(std::size_t count, const Body& body) {
  constexpr std::size_t kPoints = 1024;
  renderer::parallel_for((count + kPoints - 1) / kPoints,
                         [&](std::size_t chunk) { body(chunk * kPoints, std::min(count, (chunk + 1) * kPoints)); });
}

template <class Lanes>
std::vector<Lanes> direct_at_gather_points(const RayTracer& tracer, const GatherOperator& gather,
                                           std::span<const Vec3f> lights) {
  std::vector<Lanes> direct(gather.points.size());
  for_each_chunk(direct.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t l = 0; l < lights.size(); ++l) {
      for (std::size_t i = first; i < last; ++i) {
        const float value = direct_at_gather_point(tracer, gather, i, lights[l]);
        for (auto& channel : direct[i].channel) channel[l] = value;
      }
    }
  });
  return direct;
}

template <class Lanes>
void append_indirect(const RayTracer& tracer, const GatherOperator& gather, std::span<const Vec3f> lights,
                     std::vector<std::vector<Vec3f>>& all, const renderer::Control& control) {
  const auto direct = direct_at_gather_points<Lanes>(tracer, gather, lights);
  const std::vector<Lanes> indirect = from_gather_points(gather, direct, control);
  std::vector<float> of_light(direct.size());
  for (std::size_t l = 0; l < lights.size(); ++l) {
    for (std::size_t i = 0; i < direct.size(); ++i) of_light[i] = direct[i].channel[0][l];
    std::vector<Vec3f>& sum = all.emplace_back(change_by_bright_spot(tracer, gather, lights[l], of_light));
    for (std::size_t i = 0; i < sum.size(); ++i) {
      for (int c = 0; c < 3; ++c) sum[i][c] += indirect[i].channel[c][l];
    }
  }
}

}  // namespace

double bytes_to_make_gather_points(const GatherOptions& options) {
  constexpr double kBytesPerPath = 190;  // of up to kPathLength samples, twice
  const double paths = kBytesPerPath * options.paths_per_point;
  const double rows = 2 * double(kMostGatherPoints) * options.rays_per_point * double(sizeof(SparseTransport::Entry));
  return std::max(paths, paths / 2 + rows) * options.points_per_sample * options.samples;
}

GatherOperator make_gather_points(const RayTracer& tracer, std::span<const SurfaceSample> receivers,
                                  const GatherOptions& options, const renderer::Control& control) {
  GatherOperator gather;
  gather.bounces = options.bounces;
  if (options.bounces == 0) return gather;
  const std::size_t wanted = std::size_t(options.samples) * options.points_per_sample;
  place_gather_points(
      gather, tracer,
      trace_gather_paths(tracer, receivers, std::size_t(options.paths_per_point) * wanted, options.seed + 1, control),
      wanted, control);
  if (gather.points.empty()) return gather;
  gather.interreflection =
      make_interreflection(trace_rows(tracer, gather.points, all_of(gather.points.size()), options.rays_per_point,
                                      options.seed + 2, *gather.nearest, control));
  gather.ray_count = gather.points.size() * std::size_t(options.rays_per_point);
  return gather;
}

SparseTransport trace_receiver_rows(const RayTracer& tracer, const GatherOperator& gather,
                                    std::span<const SurfaceSample> receivers, std::span<const std::size_t> chosen,
                                    const GatherOptions& options, const renderer::Control& control) {
  return trace_rows(tracer, receivers, chosen, options.samples, options.seed + 3, *gather.nearest, control);
}

GatherOperator make_gather_operator(const RayTracer& tracer, std::span<const SurfaceSample> receivers,
                                    const GatherOptions& options, const renderer::Control& control) {
  GatherOperator gather = make_gather_points(tracer, receivers, options, control);
  gather.receivers.assign(receivers.begin(), receivers.end());
  gather.rays_per_receiver = options.samples;
  if (gather.points.empty()) {
    gather.receiver_from_point = SparseTransport::from_rows({receivers.size(), std::vector<SparseTransport::Entry>{}});
    return gather;
  }
  gather.receiver_from_point =
      trace_receiver_rows(tracer, gather, receivers, all_of(receivers.size()), options, control);
  gather.ray_count += receivers.size() * std::size_t(options.samples);
  return gather;
}

std::vector<LightBlock> illumination_of_gather_points(const RayTracer& tracer, const GatherOperator& gather,
                                                      std::span<const Vec3f> lights, const renderer::Control& control) {
  return sum_of_bounces(gather.interreflection, direct_at_gather_points<LightBlock>(tracer, gather, lights),
                        gather.bounces, control);
}

std::vector<LightBlock> indirect_illumination(const RayTracer& tracer, const GatherOperator& gather,
                                              std::span<const Vec3f> lights) {
  return from_gather_points(gather, direct_at_gather_points<LightBlock>(tracer, gather, lights));
}

std::vector<std::vector<Vec3f>> indirect_illumination_by_light(const RayTracer& tracer, const GatherOperator& gather,
                                                               std::span<const Vec3f> lights,
                                                               const renderer::Control& control) {
  std::vector<std::vector<Vec3f>> all;
  while (!lights.empty()) {
    control.stop_if_requested();
    const auto some = lights.first(lights_at_once(lights.size()));
    if (some.size() == 1) {
      append_indirect<OneLight>(tracer, gather, some, all, control);
    } else if (some.size() <= LightQuad::kLanes) {
      append_indirect<LightQuad>(tracer, gather, some, all, control);
    } else {
      append_indirect<LightBlock>(tracer, gather, some, all, control);
    }
    lights = lights.subspan(some.size());
  }
  return all;
}

std::vector<OneLight> indirect_illumination(const RayTracer& tracer, const GatherOperator& gather,
                                            const UnityLight& light) {
  std::vector<OneLight> direct(gather.points.size());
  for_each_chunk(direct.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const auto value = float(direct_term_at_gather_point(tracer, gather, i, light).value);
      for (auto& channel : direct[i].channel) channel[0] = value;
    }
  });
  return from_gather_points(gather, direct);
}

std::vector<LightQuad> indirect_illumination_with_gradient(const RayTracer& tracer, const GatherOperator& gather,
                                                           const UnityLight& light) {
  std::vector<LightQuad> direct(gather.points.size());
  for_each_chunk(direct.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const DirectTerm term = direct_term_at_gather_point(tracer, gather, i, light);
      for (auto& channel : direct[i].channel) {
        channel[0] = float(term.value);
        for (int a = 0; a < 3; ++a) channel[a + 1] = float(term.gradient[a]);
      }
    }
  });
  return from_gather_points(gather, direct);
}

std::vector<LightBlock> importance_of_gather_points(const GatherOperator& gather,
                                                    std::span<const std::size_t> receivers) {
  if (gather.points.empty()) return {};
  std::vector<LightBlock> first(gather.points.size());
  for (std::size_t l = 0; l < receivers.size(); ++l) {
    for (const SparseTransport::Entry& entry : gather.receiver_from_point.row(receivers[l])) {
      for (int c = 0; c < 3; ++c) first[entry.column].channel[c][l] += entry.weight[c];
    }
  }
  return sum_of_bounces(transposed(gather.interreflection), first, gather.bounces);
}

std::vector<Vec3f> indirect_illumination_at(const RayTracer& tracer, const GatherOperator& gather,
                                            std::span<const LightBlock> importance, std::size_t receiver_count,
                                            Vec3f light) {
  std::vector<float> direct(gather.points.size());
  for_each_chunk(direct.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      direct[i] = direct_at_gather_point(tracer, gather, i, light);
    }
  });
  LightBlock sum;
  for (std::size_t i = 0; i < direct.size(); ++i) {
    if (direct[i] <= 0) continue;
    for (int c = 0; c < 3; ++c) {
      for (int l = 0; l < kLightBlock; ++l) sum.channel[c][l] += direct[i] * importance[i].channel[c][l];
    }
  }
  std::vector<Vec3f> result(receiver_count);
  for (std::size_t l = 0; l < receiver_count; ++l) {
    result[l] = {sum.channel[0][l], sum.channel[1][l], sum.channel[2][l]};
  }
  return result;
}

}  // namespace chiaro::inverse

#include "renderer/trace/path_tracer.h"

#include <limits>

#include "renderer/trace/path_vertex.h"

namespace chiaro::renderer {
namespace {

// From this vertex on a path survives with the probability of its throughput, at most kMostSurvival so that it ends
// among surfaces of albedo 1 too.
constexpr int kRouletteVertex = 3;
constexpr float kMostSurvival = 0.995F;

// Light subpaths are as long as this part of the scene's diagonal at most. Their business is the bright spot close to a
// light; farther away scattered rays find as much, for less.
constexpr float kSubpathReach = 0.1F;

// Emission from no triangle at all, where the scene's own is not wanted.
const Scene& scene_without_emission() {
  static const Scene empty;
  return empty;
}

// Where its rays begin.
Media media_around(const RayTracer& tracer, const Light& light) {
  if (const auto* point = std::get_if<PointLight>(&light)) return Media::at(tracer, point->position);
  if (const auto* spot = std::get_if<SpotLight>(&light)) return Media::at(tracer, spot->position);
  return {};
}

// Finer than floats, so that none of very many lights is out of reach.
double next_fine(Sampler& sampler) {
  const double coarse = double(sampler.next_1d());
  return coarse + double(sampler.next_bits()) * 0x1p-56;
}

}  // namespace

PathTracer::PathTracer(const RayTracer& tracer, const Lights& lights, const TraceOptions& options,
                       LightVisibility* visibility)
    : tracer_(tracer),
      lights_(lights),
      selection_(lights, visibility),
      emission_(lights),
      subpath_reach_(kSubpathReach * tracer.bounds().diagonal()),
      emitters_(options.scene_emission ? tracer.scene() : scene_without_emission()),
      bounces_(options.bounces < 0 ? std::numeric_limits<int>::max() : options.bounces),
      wide_highlights_(options.wide_highlights),
      clear_surfaces_(has_clear_surfaces(tracer.scene())),
      solids_(has_solids(tracer.scene())) {
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (const auto* light = std::get_if<EnvironmentLight>(&lights[i]); light != nullptr && light->intensity > 0) {
      environments_.push_back({i, EnvironmentSampling(*light)});
    }
  }
  if (!solids_) return;
  for (const Light& light : lights) light_media_.push_back(media_around(tracer, light));
}

// rough: after rough scattering.
LightSource PathTracer::punctual_source(bool rough) const {
  if (!wide_highlights_) return LightSource::kPunctual;
  return rough ? LightSource::kPunctualBlurred : LightSource::kPunctualWidened;
}

// As a camera's ray finds it.
PathTracer::Vertex PathTracer::vertex_at(const SurfacePoint& point, const Bsdf& bsdf, Vec3f to_viewer,
                                         int index) const {
  return {.position = point.position,
          .normal = point.geometric_normal,
          .rounding = point.rounding,
          .to_viewer = to_viewer,
          .bsdf = &bsdf,
          .index = index,
          .lift = point.lift,
          .triangle_normal = point.geometric_normal,
          .punctual = punctual_source(false)};
}

// behind: where the vertex may keep those of its other side.
void PathTracer::know_media(Vertex& vertex, const SurfacePoint& point, const Media& media,
                            std::optional<Media>& behind) const {
  if (!solids_) return;
  vertex.media = &media;
  if (!vertex.transmits()) return;
  behind = media;
  behind->cross(point);
  vertex.behind = &*behind;
}

// 0: nothing arrives, 1: nothing is in between.
Vec3f PathTracer::light_along(const Ray& ray, const Media* media) const {
  const Passage passage = tracer_.passage(ray);
  if (passage == Passage::kBlocked) return {};
  if (passage == Passage::kClear) return clear_transmittance(tracer_, ray, media != nullptr ? *media : Media());
  return media != nullptr ? media->transmittance(ray.far * length(ray.direction)) : Vec3f{1, 1, 1};
}

Vec3f PathTracer::light_through(const Vertex& v, const LightSample& from, std::uint32_t alpha_seed) const {
  Ray ray{v.ray_origin(from.to_light), from.to_light};
  if (from.reach != kInfinity) {  // from the vertex, and not from where the ray begins
    ray.direction = v.position + from.reach * from.to_light - ray.origin, ray.far = 1;
  }
  ray.alpha_seed = alpha_seed;
  ray.clear = from.clear;
  if (!v.sees_past_triangle(from.to_light)) return light_along(ray, v.media_towards(from.to_light));
  const Vec3f lifted = offset_point(v.position + v.lift, v.normal, v.rounding);
  Ray up = ray;
  up.direction = lifted - ray.origin, up.far = 1;
  const Vec3f to_lifted = light_along(up, v.media);
  if (!(max_component(to_lifted) > 0)) return {};
  ray.origin = lifted;
  if (from.distance != kInfinity) {
    ray.direction = v.position + from.distance * from.to_light - lifted, ray.far = from.reach / from.distance;
  }
  return to_lifted * light_along(ray, v.media);
}

// `value`: what the sample brings if nothing stands between.
void PathTracer::add_if_seen(const Vertex& v, std::size_t source, const LightSample& from, Vec3f value,
                             Path& path) const {
  if (!(max_component(value) > 0)) return;
  path.light.add(v.index, source, light_through(v, from, path.sampler.next_bits()) * value);
}

void PathTracer::add_punctual_if_seen(const Vertex& v, std::size_t light, const PunctualSample& s, Vec3f value,
                                      Path& path) const {
  if (!(max_component(value) > 0)) return;
  const Vec3f through = light_through(
      v, {s.to_light, s.distance, (1 - kShortOfLight) * s.distance, ClearSurfaces::kPassAll}, path.sampler.next_bits());
  selection_.record(light, v.position, v.pick_normal(), max_component(through) > 0);
  path.light.add(v.index, light, through * value);
}

void PathTracer::add_all_punctual(const Vertex& v, Vec3f throughput, Path& path) const {
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    const PunctualSample s = sample_punctual(lights_[i], v.position);
    const Vec3f value = throughput * v.eval(s.to_light, v.punctual) * s.irradiance;
    add_punctual_if_seen(v, i, s, value, path);
  }
}

// One of many, by what the viewer would see of it.
void PathTracer::add_one_seen(const Vertex& v, Vec3f throughput, Path& path) const {
  const Bsdf::Sketch surface = v.bsdf != nullptr ? v.bsdf->sketch() : Bsdf::Sketch{};
  const auto [i, probability] =
      selection_.pick(v.position, v.pick_normal(), v.to_viewer, surface, next_fine(path.sampler));
  if (!(probability > 0)) return;
  const PunctualSample s = sample_punctual(lights_[i], v.position);
  const Vec3f value = throughput * v.eval(s.to_light, v.punctual) * s.irradiance / probability;
  if (is_finite(value)) add_punctual_if_seen(v, i, s, value, path);
}

// One of all, beyond vertex 0. Weighted against a ray from that light having ended here.
void PathTracer::add_one_punctual(const Vertex& v, Vec3f throughput, Path& path) const {
  const auto [i, probability] = selection_.pick(v.position, v.pick_normal(), next_fine(path.sampler));
  if (!(probability > 0)) return;
  const PunctualSample s = sample_punctual(lights_[i], v.position);
  const Vec3f value = throughput * v.eval(s.to_light, v.punctual) * s.irradiance / probability;
  if (!is_finite(value)) return;  // closer to the light than floats can tell
  float weight = 1;
  const float cosine = v.incident_cosine(s.to_light);
  if (s.distance <= subpath_reach_ && cosine > 0) {
    const float subpath_pdf = emission_.pdf(i, -s.to_light) * cosine / (s.distance * s.distance);
    weight = balance_heuristic(v.area_pdf * probability, subpath_pdf);
  }
  add_punctual_if_seen(v, i, s, weight * value, path);
}

void PathTracer::add_emissive(const Vertex& v, Vec3f throughput, Path& path) const {
  const double pick = next_fine(path.sampler);
  const EmissiveTriangles::Sample s = emitters_.sample(v.position, v.pick_normal(), pick, path.sampler.next_2d());
  if (!(s.pdf > 0)) return;
  const Vec3f value = throughput * v.eval(s.to_light) * s.radiance / s.pdf;
  const float weight = balance_heuristic(s.pdf, v.pdf(s.to_light));
  add_if_seen(v, emission_source(), {s.to_light, s.distance, s.reach, ClearSurfaces::kPassThin}, weight * value, path);
}

void PathTracer::add_environments(const Vertex& v, Vec3f throughput, Path& path) const {
  for (const Environment& environment : environments_) {
    const EnvironmentSampling::Sample s = environment.sampling.sample(path.sampler.next_2d());
    if (!(s.pdf > 0)) continue;
    const Vec3f value = throughput * v.eval(s.direction) * s.radiance / s.pdf;
    const float weight = balance_heuristic(s.pdf, v.pdf(s.direction));
    add_if_seen(v, environment.source, {s.direction, kInfinity, kInfinity, ClearSurfaces::kPassThin}, weight * value,
                path);
  }
}

// What a scattered ray finds that meets nothing.
void PathTracer::add_missed(const ScatteredRay& ray, int index, Vec3f throughput, Path& path) const {
  if (ray.from_camera()) return add_background(ray.direction, throughput, path.light);
  for (const Environment& environment : environments_) {
    const float weight = balance_heuristic(ray.pdf, environment.sampling.pdf(ray.direction));
    path.light.add(index - 1, environment.source, weight * throughput * environment.sampling.radiance(ray.direction));
  }
}

void PathTracer::add_background(Vec3f direction, Vec3f throughput, PathLight& light) const {
  for (const Environment& environment : environments_) {
    light.add(0, environment.source, throughput * environment.sampling.radiance(direction));
  }
}

void PathTracer::add_punctual(const Vertex& v, Vec3f throughput, Path& path) const {
  if (lights_.empty()) return;
  if (v.index > 0) {
    add_one_punctual(v, throughput, path);
  } else if (selection_.few()) {
    add_all_punctual(v, throughput, path);
  } else {
    add_one_seen(v, throughput, path);
  }
}

// The light of one vertex, but for what scattered rays bring.
void PathTracer::add_lights(const Vertex& v, Vec3f throughput, Path& path) const {
  add_punctual(v, throughput, path);
  add_indirect_samples(v, throughput, path);
}

void PathTracer::add_indirect_samples(const Vertex& v, Vec3f throughput, Path& path) const {
  if (v.index < bounces_) {
    for (const LightVertex& y : path.light_vertices) connect(v, y, throughput, path);
  }
  if (!emitters_.empty()) add_emissive(v, throughput, path);
  add_environments(v, throughput, path);
}

void PathTracer::ScatteredRay::go_straight(const SurfacePoint& through, float distance) {
  origin = point_behind(through);
  travelled += distance;
  media.cross(through);
}

// What the ray finds, weighted against light samples at the vertex that it left.
void PathTracer::add_emission(const SurfacePoint& point, const Hit& hit, const ScatteredRay& ray, int index,
                              Vec3f throughput, Path& path) const {
  if (!(max_component(point.emission) > 0)) return;
  if (ray.from_camera()) return path.light.add(0, emission_source(), throughput * point.emission);
  if (emitters_.empty()) return;
  const float weight = balance_heuristic(ray.pdf, emitters_.pdf(hit, ray.position, ray.normal, point.position));
  path.light.add(index - 1, emission_source(), weight * throughput * point.emission);
}

// Turns `ray` as the surface scatters it; false: nothing goes on. A ray that goes straight through keeps its density.
bool PathTracer::scatter(const Vertex& vertex, const SurfacePoint& point, Sampler& sampler, ScatteredRay& ray,
                         Vec3f& throughput) const {
  const Vec2f u = sampler.next_2d();
  const auto next = vertex.bsdf->sample(vertex.to_viewer, u, sampler.next_1d());
  if (!next) return false;
  throughput *= next->weight;
  const Vec3f origin = vertex.ray_origin(next->direction);
  ray.turned = !next->straight;
  if (next->straight) {
    ray.go_straight(point, length(point.position - ray.origin));
    return true;
  }
  if (vertex.transmits_to(next->direction)) ray.media.cross(point);
  ray.origin = origin;
  ray.position = vertex.position;
  ray.normal = vertex.pick_normal();
  ray.direction = next->direction;
  ray.pdf = next->pdf;
  ray.travelled = 0;
  ray.rough = ray.rough || next->rough;
  return true;
}

void PathTracer::trace(ScatteredRay scattered, int index, Vec3f throughput, Path& path) const {
  for (int straight = 0; straight < kMostClearSurfaces;) {
    Ray ray{scattered.origin, scattered.direction, 0, kInfinity, path.sampler.next_bits()};
    ray.of_camera = scattered.from_camera();
    const auto hit = tracer_.intersect(ray);
    if (!hit) {
      if (solids_) throughput *= scattered.media.transmittance(kInfinity);
      return add_missed(scattered, index, throughput, path);
    }
    const SurfacePoint point = make_surface_point(tracer_.scene(), ray, *hit);
    if (solids_) throughput *= scattered.media.transmittance(point, hit->distance);
    add_emission(point, *hit, scattered, index, throughput, path);
    if (point.unlit || (index > bounces_ && !clear_surfaces_)) return;
    const Bsdf bsdf(point);
    const Vec3f to_viewer = -scattered.direction;
    if (index > bounces_) {
      throughput *= bsdf.straight(to_viewer);
      if (!(max_component(throughput) > 0)) return;
      scattered.go_straight(point, hit->distance);
      ++straight;
      continue;
    }
    const float cosine = dot(point.geometric_normal, to_viewer), distance = scattered.travelled + hit->distance;
    Vertex vertex = vertex_at(point, bsdf, to_viewer, index);
    vertex.area_pdf = scattered.pdf * cosine / (distance * distance);
    vertex.punctual = punctual_source(scattered.rough);
    std::optional<Media> behind;
    know_media(vertex, point, scattered.media, behind);
    add_lights(vertex, throughput, path);
    if (index == bounces_ && !has_emission() && !clear_surfaces_) return;
    if (!scatter(vertex, point, path.sampler, scattered, throughput)) return;
    const bool turned = scattered.turned;
    if (turned && index == bounces_ && !has_emission()) return;
    if (turned && index + 1 >= kRouletteVertex) {
      const float survival = std::min(kMostSurvival, max_component(throughput));
      if (!(path.sampler.next_1d() < survival)) return;
      throughput *= 1 / survival;
    }
    straight = turned ? 0 : straight + 1;
    index += turned ? 1 : 0;
  }
}

void PathTracer::add_scattered(const SurfacePoint& point, const Media& media, Vec3f to_viewer, int index,
                               Vec3f throughput, Sampler& sampler, PathLight& light) const {
  if (point.unlit) return;
  const Bsdf bsdf(point);
  Vertex vertex = vertex_at(point, bsdf, to_viewer, index);
  std::optional<Media> behind;
  know_media(vertex, point, media, behind);
  Path path = start_path(sampler, light);
  add_lights(vertex, throughput, path);
  if (index == bounces_ && !has_emission() && !clear_surfaces_) return;
  ScatteredRay ray{
      .origin = point.position + to_viewer, .direction = -to_viewer, .position = {}, .normal = {}, .media = media};
  if (!scatter(vertex, point, sampler, ray, throughput)) return;
  trace(ray, ray.turned ? index + 1 : index, throughput, path);
}

PathTracer::Vertex PathTracer::vertex_at(const Receiver& receiver) const {
  Vertex vertex{receiver.position, receiver.normal, 0, receiver.normal, nullptr, 0};
  vertex.stand_off = receiver.stand_off * receiver.normal;
  vertex.media = solids_ ? &receiver.media : nullptr;
  return vertex;
}

void PathTracer::add_punctual_illumination(const Receiver& receiver, Sampler& sampler, PathLight& light) const {
  Path path{sampler, light, {}};
  add_all_punctual(vertex_at(receiver), {1, 1, 1}, path);
}

void PathTracer::add_illumination(const Receiver& receiver, bool with_punctual, Sampler& sampler,
                                  PathLight& light) const {
  const Vertex vertex = vertex_at(receiver);
  Path path = start_path(sampler, light);
  if (with_punctual) add_punctual(vertex, {1, 1, 1}, path);
  add_indirect_illumination(vertex, path);
}

void PathTracer::add_illumination(const SurfacePoint& point, const Media& media, Sampler& sampler,
                                  PathLight& light) const {
  // Rays start along the shading normal, which leans: as far off the surface as they would along the geometric one.
  constexpr float kLeastCosine = 0.1F;
  const Vec3f normal = point.shading_normal;
  const float rounding = point.rounding / std::max(kLeastCosine, dot(normal, point.geometric_normal));
  Vertex vertex{point.position, normal, rounding, normal, nullptr, 0, 0, point.lift, point.geometric_normal};
  vertex.media = solids_ ? &media : nullptr;
  Path path = start_path(sampler, light);
  add_punctual(vertex, {1, 1, 1}, path);
  add_indirect_illumination(vertex, path);
}

void PathTracer::add_indirect_illumination(const Vertex& vertex, Path& path) const {
  add_indirect_samples(vertex, {1, 1, 1}, path);
  if (bounces_ == 0 && !has_emission()) return;
  const Vec3f local = sample_cosine_hemisphere(path.sampler.next_2d());
  if (!(local.z > 0)) return;
  const Vec3f direction = normalize(Frame3f(vertex.normal).world_from_local(local));
  // Illumination is the mean of incident radiance over cosine-weighted directions.
  trace({.origin = vertex.ray_origin(direction),
         .direction = direction,
         .pdf = local.z * kInvPi,
         .position = vertex.position,
         .normal = vertex.pick_normal(),
         .rough = true,
         .media = vertex.media != nullptr ? *vertex.media : Media()},
        1, {1, 1, 1}, path);
}

bool has_blended_surfaces(const Scene& scene) {
  return any_drawn_material(scene, [](const Material& m) { return m.alpha_mode == AlphaMode::kBlend; });
}

}  // namespace chiaro::renderer

#pragma once
// The light transport estimator that frames and illumination share: path tracing from the eye or the receiver with
// next-event estimation, Russian roulette, and multiple importance sampling where it matters:
// - emissive surfaces and environments are found by light samples and by scattered rays;
// - the bright spot that a point light makes on a surface close to it, which scattered rays rarely meet, is found by a
//   ray from the light too: one for each path, whose end all its vertices are connected with (bidirectional path
//   tracing with light subpaths of two vertices).
// Of a few punctual lights, vertex 0 asks all, and later vertices one. Of more, vertex 0 asks some, spread evenly over
// what each would bring if nothing stood between, and later vertices one.
// Clear surfaces (glass, see clear_surfaces.h) let scattered rays through by chance, and light samples in full: thin
// ones all of them, boundaries of solids those of punctual lights.
//
// Source: Veach, Robust Monte Carlo Methods for Light Transport Simulation, 1997 (balance heuristic: eq. 9.8; ch. 10).

#include <optional>
#include <vector>

#include "renderer/core/sampler.h"
#include "renderer/trace/bsdf.h"
#include "renderer/trace/clear_surfaces.h"
#include "renderer/trace/environment_sampling.h"
#include "renderer/trace/light_sampling.h"
#include "renderer/trace/light_selection.h"
#include "renderer/trace/trace_options.h"

namespace chiaro::renderer {

// Light that came by one path, taken apart. Vertex 0 is the surface whose light is asked for.
struct PathLight {
  Vec3f direct;    // from an emitter to vertex 0
  Vec3f indirect;  // through one further surface or more
  // Per light, and the emissive surfaces last; empty: not asked for. direct + indirect = their sum.
  std::vector<Vec3f> per_light;
  // Brighter contributions are scaled down until their largest channel is this, cd/m².
  float clamp_direct = kInfinity, clamp_indirect = kInfinity;

  void add(int vertex, std::size_t source, Vec3f value) {
    const float most = vertex == 0 ? clamp_direct : clamp_indirect, brightest = max_component(value);
    if (brightest > most) value *= most / brightest;
    (vertex == 0 ? direct : indirect) += value;
    if (!per_light.empty()) per_light[source] += value;
  }
};

class PathTracer {
 public:
  // A point on a surface that is white.
  struct Receiver {
    Vec3f position, normal;
    float stand_off = 0;  // metres in front of it that its rays begin
    Media media{};        // on the side of the normal
  };

  // Keeps references to all, which must outlive it. How many samples are taken is the caller's business, and so is to
  // let `visibility` learn; nullptr: nothing is learnt.
  PathTracer(const RayTracer& tracer, const Lights& lights, const TraceOptions& options,
             LightVisibility* visibility = nullptr);

  // The solids that a point is inside of, which absorb what comes to it. It is on no surface.
  Media media_at(Vec3f position) const { return solids_ ? Media::at(tracer_, position) : Media(); }

  // Radiance leaving `vertex` towards to_viewer, its emission left out, times `throughput`, added to `light`.
  // `index` is the number of `vertex` on its path. media: on the viewer's side.
  void add_scattered(const SurfacePoint& vertex, const Media& media, Vec3f to_viewer, int index, Vec3f throughput,
                     Sampler& sampler, PathLight& light) const;

  // What a ray of the camera that meets nothing sees, times `throughput`: environments.
  void add_background(Vec3f direction, Vec3f throughput, PathLight& light) const;

  // Illumination (irradiance / π) of a surface point by one path. `with_punctual`: its direct light from punctual
  // lights too.
  void add_illumination(const Receiver& receiver, bool with_punctual, Sampler& sampler, PathLight& light) const;
  // The same of a point that a ray has met, by its shading normal, with punctual lights.
  void add_illumination(const SurfacePoint& point, const Media& media, Sampler& sampler, PathLight& light) const;
  // Direct light from each punctual light, which needs no more than one sample where no surface is alpha-blended.
  void add_punctual_illumination(const Receiver& receiver, Sampler& sampler, PathLight& light) const;

  // Whether direct light comes from more than punctual lights, so that scattered rays find it too.
  bool has_emission() const { return !emitters_.empty() || !environments_.empty(); }
  std::size_t emission_source() const { return lights_.size(); }

 private:
  struct Vertex;
  struct Environment {
    std::size_t source;
    EnvironmentSampling sampling;
  };
  // A ray that leaves a vertex, or goes on through a clear surface as it came.
  struct ScatteredRay {
    Vec3f origin, direction;
    float pdf = kInfinity;   // of the direction, per steradian; infinite: a camera's
    Vec3f position, normal;  // of the vertex that scattered it, as lights are picked for it
    float travelled = 0;     // metres from there to origin
    bool turned = false;     // by the surface that it leaves
    bool rough = false;      // light has been scattered widely on the way
    Media media;             // at origin

    bool from_camera() const { return pdf == kInfinity; }
    void go_straight(const SurfacePoint& through, float distance);
  };
  // Where light comes from to a vertex.
  struct LightSample {
    Vec3f to_light;       // unit
    float distance;       // metres
    float reach;          // metres that a shadow ray goes, a little less
    ClearSurfaces clear;  // that it passes
  };
  // A surface that a light's ray has arrived at.
  struct LightVertex {
    PunctualEmission::Sample from;
    Hit hit;
    float distance;  // metres
    Vec3f through;   // what clear surfaces have left of the ray
  };
  // One path from vertex 0 on.
  struct Path {
    Sampler& sampler;
    PathLight& light;
    std::vector<LightVertex> light_vertices;  // of its light subpath: one, and more behind clear surfaces
  };
  void add_indirect_illumination(const Vertex& vertex, Path& path) const;
  Vertex vertex_at(const Receiver& receiver) const;
  void trace(ScatteredRay ray, int index, Vec3f throughput, Path& path) const;
  void add_emission(const SurfacePoint& point, const Hit& hit, const ScatteredRay& ray, int index, Vec3f throughput,
                    Path& path) const;
  bool scatter(const Vertex& vertex, const SurfacePoint& point, Sampler& sampler, ScatteredRay& ray,
               Vec3f& throughput) const;
  void add_if_seen(const Vertex& vertex, std::size_t source, const LightSample& from, Vec3f value, Path& path) const;
  void add_lights(const Vertex& vertex, Vec3f throughput, Path& path) const;
  void add_indirect_samples(const Vertex& vertex, Vec3f throughput, Path& path) const;
  void add_punctual(const Vertex& vertex, Vec3f throughput, Path& path) const;
  void add_punctual_if_seen(const Vertex& vertex, std::size_t light, const PunctualSample& sample, Vec3f value,
                            Path& path) const;
  void add_all_punctual(const Vertex& vertex, Vec3f throughput, Path& path) const;
  void add_one_seen(const Vertex& vertex, Vec3f throughput, Path& path) const;
  void add_one_punctual(const Vertex& vertex, Vec3f throughput, Path& path) const;
  void know_media(Vertex& vertex, const SurfacePoint& point, const Media& media, std::optional<Media>& behind) const;
  Vertex vertex_at(const SurfacePoint& point, const Bsdf& bsdf, Vec3f to_viewer, int index) const;
  Path start_path(Sampler& sampler, PathLight& light) const;
  std::vector<LightVertex> trace_light_subpath(Sampler& sampler) const;
  void connect(const Vertex& vertex, const LightVertex& y, Vec3f throughput, Path& path) const;
  void add_emissive(const Vertex& vertex, Vec3f throughput, Path& path) const;
  void add_environments(const Vertex& vertex, Vec3f throughput, Path& path) const;
  void add_missed(const ScatteredRay& ray, int index, Vec3f throughput, Path& path) const;
  LightSource punctual_source(bool rough) const;
  Vec3f light_through(const Vertex& vertex, const LightSample& from, std::uint32_t alpha_seed) const;
  Vec3f light_along(const Ray& ray, const Media* media) const;

  const RayTracer& tracer_;
  const Lights& lights_;
  LightSelection selection_;
  PunctualEmission emission_;
  float subpath_reach_;  // metres
  EmissiveTriangles emitters_;
  std::vector<Environment> environments_;
  int bounces_;
  bool wide_highlights_;
  bool clear_surfaces_, solids_;    // in the scene
  std::vector<Media> light_media_;  // around each light; empty: there are no solids
};

// Whether any material is alpha-blended, so that shadows are a matter of chance.
bool has_blended_surfaces(const Scene& scene);

}  // namespace chiaro::renderer

#pragma once
// Rays against the scene, through Embree. Immutable and thread-safe once built.

#include <cstdint>
#include <memory>
#include <optional>

#include "renderer/scene/scene.h"

namespace chiaro::renderer {

// Which clear surfaces (is_clear) a ray passes as if they were not there.
enum class ClearSurfaces : std::uint8_t {
  kStop,
  kPassThin,      // and boundaries of solids that do not bend light
  kPassAll,       // boundaries of all solids too
  kPassByChance,  // all, with the probability that is the luminance of what they let through: by alpha_seed
};

struct Ray {
  Vec3f origin;
  Vec3f direction;  // unit, unless near and far are meant in its length
  float near = 0, far = kInfinity;
  std::uint32_t alpha_seed = 0;  // decides which alpha-blended surfaces the ray passes: 1 − alpha of all seeds do
  // The cone that a camera's ray stands for, for texture filtering: its width at the origin, metres, and by how much it
  // grows with each metre. Zero: textures are looked up in full, as scattered rays do, whose mean no filter may change.
  float cone_width = 0, cone_spread = 0;
  ClearSurfaces clear = ClearSurfaces::kStop;
  bool of_camera = false;  // sees unlit surfaces, which all others pass, and passes backs that are hidden
  bool meets_all = false;  // every triangle, whatever it lets through
};

enum class Passage : std::uint8_t {
  kFree,
  kClear,  // there may be clear surfaces on the way, and nothing else
  kBlocked,
};

struct Hit {
  float distance = 0;  // in lengths of the direction
  float u = 0, v = 0;  // barycentric: point = (1 − u − v) p0 + u p1 + v p2
  std::uint32_t instance = 0, triangle = 0;
  Vec3f geometric_normal;  // unit, world, on the side of the triangle's winding; not flipped towards the ray
  bool instanced = false;  // met in object space, and not among the world's own triangles
};

// Shadow rays end before a punctual light by so much of their length: it may stand on a surface.
inline constexpr float kShortOfLight = 1e-5F;

// A ray from `from` that ends a little short of `to`: from afar, floats cannot tell `to` from the surface that it was
// moved off.
Ray ray_between(Vec3f from, Vec3f to, std::uint32_t alpha_seed);

class RayTracer {
 public:
  // Keeps a reference to `scene`, which must outlive it. Error when memory runs out.
  explicit RayTracer(const Scene& scene);
  ~RayTracer();
  RayTracer(const RayTracer&) = delete;
  RayTracer& operator=(const RayTracer&) = delete;

  const Scene& scene() const { return scene_; }
  const Box3f& bounds() const { return bounds_; }  // world; of the drawn triangles

  std::optional<Hit> intersect(const Ray& ray) const;
  bool occluded(const Ray& ray) const { return passage(ray) == Passage::kBlocked; }
  Passage passage(const Ray& ray) const;
  // Whether anything stands between two points, both already moved off their surfaces. Where one of them is a light,
  // let it be `to`: rays miss the surface that they start from more surely than one that they come to from afar.
  // Clear surfaces are passed by chance, as alpha-blended ones are.
  bool occluded_between(Vec3f from, Vec3f to, std::uint32_t alpha_seed) const;
  // The part of all alpha_seeds with which nothing does: alpha-blended and clear surfaces (by luminance) let through
  // what they do on average.
  float transmittance_between(Vec3f from, Vec3f to) const;

 private:
  struct Embree;
  const Scene& scene_;
  Box3f bounds_;
  std::unique_ptr<Embree> embree_;
};

// How far, metres, float rounding may take a point of a triangle off the plane that rays meet: by the largest
// coordinate of the corners and the radius of the circle through them.
float surface_rounding(float largest_coordinate, float radius);

// `point` moved off its surface to the side of `normal`, by `rounding` metres, and no less than rounding at the point's
// own magnitude calls for.
Vec3f offset_point(Vec3f point, Vec3f normal, float rounding = 0);

}  // namespace chiaro::renderer

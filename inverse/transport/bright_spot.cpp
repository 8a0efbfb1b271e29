#include "inverse/transport/bright_spot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "inverse/transport/nearest_gather_point.h"
#include "renderer/core/control.h"
#include "renderer/core/sampler.h"
#include "renderer/trace/bsdf.h"

namespace chiaro::inverse {

using renderer::RayTracer;
using renderer::SurfacePoint;
using renderer::SurfaceSample;
using renderer::Vec3f;

namespace {

constexpr float kReach = 0.05F;     // of a light's rays, of the scene's diagonal: from farther away receivers find more
constexpr std::size_t kRays = 32;   // of the light, in each of …
constexpr std::size_t kSets = 4;    // … so many sets: neighbouring receivers are connected with other ones
constexpr float kApart = 4.0F;      // cell radii: closer to a receiver only its own rays find a cell
constexpr std::uint64_t kSeed = 0x5b07;

// Where a ray of the light has arrived.
struct LitPoint {
  SurfacePoint at;
  renderer::Bsdf bsdf;
  std::uint32_t cell;
  Vec3f to_light;
  float cosine;  // of to_light
};

class BrightSpot {
 public:
  BrightSpot(const RayTracer& tracer, const GatherOperator& gather, Vec3f light, std::span<const float> direct)
      : tracer_(tracer), gather_(gather), direct_(direct), density_(gather.points.size()) {
    const float reach = kReach * tracer.bounds().diagonal();
    for (std::size_t i = 0; i < density_.size(); ++i) {
      // A ray per steradian of 4π, as direct light is cosθ / (π d²).
      const bool near = length_squared(gather.points[i].position - light) <= reach * reach;
      density_[i] = near ? float(kRays) * direct[i] / 4 : 0;
    }
    const bool none = std::all_of(density_.begin(), density_.end(), [](float density) { return !(density > 0); });
    for (std::size_t set = 0; set < kSets && !none; ++set) {
      for (std::size_t ray = 0; ray < kRays; ++ray) add_ray(light, 2 * reach, set, ray);
    }
  }

  bool is_dark() const {
    return std::all_of(lit_.begin(), lit_.end(), [](const auto& set) { return set.empty(); });
  }

  Vec3f change_of(std::size_t receiver) const {
    const SurfaceSample& at = gather_.receivers[receiver];
    Vec3f change;
    for (const SparseTransport::Entry& entry : gather_.receiver_from_point.row(receiver)) {
      if (density_[entry.column] > 0) change += -weight(entry.column, at) * direct_[entry.column] * entry.weight;
    }
    for (const LitPoint& lit : lit_[receiver % kSets]) change += weight(lit.cell, at) / float(kRays) * brought(lit, at);
    return change;
  }

 private:
  void add_ray(Vec3f light, float reach, std::size_t set, std::size_t index) {
    renderer::Sampler sampler(kSeed, std::uint32_t(set), std::uint32_t(index));
    const renderer::Vec2f u = sampler.next_2d();
    const float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.0F, 1 - z * z)), phi = 2 * renderer::kPi * u.y;
    renderer::Ray ray{light, {r * std::cos(phi), r * std::sin(phi), z}, 0, reach, sampler.next_bits()};
    ray.clear = renderer::ClearSurfaces::kPassByChance;
    const auto hit = tracer_.intersect(ray);
    if (!hit) return;
    const SurfacePoint point = make_surface_point(tracer_.scene(), ray, *hit);
    const Vec3f in_front = renderer::offset_point(point.position, point.geometric_normal, point.rounding);
    const auto cell = gather_.nearest->find_seen({in_front, point.shading_normal});
    const float cosine = dot(point.geometric_normal, -ray.direction);
    if (!cell || !(density_[*cell] > 0) || !(cosine > 0)) return;
    lit_[set].push_back({point, renderer::Bsdf(point), *cell, -ray.direction, cosine});
  }

  // Of rays from the light against rays from the receiver.
  float weight(std::uint32_t cell, const SurfaceSample& at) const {
    const SurfaceSample& point = gather_.points[cell];
    const Vec3f way = point.position - at.position;
    const float d2 = length_squared(way), near = kApart * gather_.cell_radius[cell];
    if (!(d2 > near * near)) return 0;
    const float cosines = std::max(0.0F, dot(way, at.normal)) * std::max(0.0F, -dot(way, point.normal));
    const float found = float(gather_.rays_per_receiver) * cosines / (renderer::kPi * d2 * d2);
    return density_[cell] / (density_[cell] + found);
  }

  // By one of the light's rays, if there were no others.
  Vec3f brought(const LitPoint& lit, const SurfaceSample& at) const {
    const Vec3f way = lit.at.position - at.position;
    const float d2 = length_squared(way), d = std::sqrt(d2);
    const float cosine_receiver = dot(way, at.normal) / d, cosine = -dot(way, lit.at.geometric_normal) / d;
    if (!(cosine_receiver > 0) || !(cosine > 0)) return {};
    const Vec3f scattered = lit.bsdf.eval(-way / d, lit.to_light, renderer::LightSource::kPunctualBlurred);
    if (!(max_component(scattered) > 0)) return {};
    const Vec3f from = renderer::offset_point(at.position, at.normal);
    const Vec3f to = renderer::offset_point(lit.at.position, lit.at.geometric_normal,
                                            std::max(lit.at.rounding, renderer::surface_rounding(d, 0)));
    renderer::Ray between = renderer::ray_between(from, to, 0);
    between.clear = renderer::ClearSurfaces::kPassThin;
    if (tracer_.occluded(between)) return {};
    return 4 * cosine_receiver * cosine / (d2 * lit.cosine) * scattered;
  }

  const RayTracer& tracer_;
  const GatherOperator& gather_;
  std::span<const float> direct_;
  std::vector<float> density_;  // of the light's rays in each cell, per m²; 0: it is none of the spot
  std::array<std::vector<LitPoint>, kSets> lit_;
};

}  // namespace

std::vector<Vec3f> change_by_bright_spot(const RayTracer& tracer, const GatherOperator& gather, Vec3f light,
                                         std::span<const float> direct) {
  std::vector<Vec3f> change(gather.receivers.size());
  const BrightSpot spot(tracer, gather, light, direct);
  if (spot.is_dark()) return change;
  renderer::parallel_for(change.size(), [&](std::size_t i) { change[i] = spot.change_of(i); });
  return change;
}

}  // namespace chiaro::inverse

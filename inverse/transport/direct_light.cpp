#include "inverse/transport/direct_light.h"

#include <cmath>

#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {

using Eigen::Vector3d;
using renderer::SurfaceSample;
using renderer::Vec3f;

float unoccluded_illumination(const SurfaceSample& at, Vec3f light) {
  const Vec3f d = light - at.on_surface();
  const float d2 = length_squared(d), projected = dot(d, at.normal);
  return projected > 0 ? projected / (renderer::kPi * d2 * std::sqrt(d2)) : 0;
}

// With r = x − p: I(v) n·r / (π |r|³), where v = 1 + r·axis / |r|.
DirectTerm unoccluded_term(const SurfaceSample& at, const UnityLight& light) {
  const Vector3d r = light.position - to_eigen(at.on_surface()), n = to_eigen(at.normal);
  const double projected = n.dot(r);
  if (projected <= 0) return {};
  const double d2 = r.squaredNorm(), d = std::sqrt(d2), scale = 1 / (EIGEN_PI * d2 * d);
  DirectTerm term{projected * scale, scale * (n - (3 * projected / d2) * r)};
  if (!light.cone) return term;
  const Vector3d axis = to_eigen(light.cone->axis);
  const double versine = 0.5 * (r / d + axis).squaredNorm();
  const Vector3d versine_gradient = (axis + ((1 - versine) / d) * r) / d;
  const auto falloff = light.cone->falloff(float(versine));
  term.gradient = double(falloff.value) * term.gradient + double(falloff.derivative) * term.value * versine_gradient;
  term.value *= double(falloff.value);
  return term;
}

bool sees(const renderer::RayTracer& tracer, const SurfaceSample& at, Vec3f light, std::uint32_t seed) {
  if (dot(light - at.on_surface(), at.normal) <= 0) return false;
  return !tracer.occluded_between(renderer::offset_point(at.position, at.normal), light, seed);
}

float visible_part(const renderer::RayTracer& tracer, const SurfaceSample& at, Vec3f light) {
  if (dot(light - at.on_surface(), at.normal) <= 0) return 0;
  return tracer.transmittance_between(renderer::offset_point(at.position, at.normal), light);
}

}  // namespace chiaro::inverse

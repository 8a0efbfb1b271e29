#include "renderer/trace/boundary_albedo.h"

#include <array>
#include <mutex>

#include "renderer/core/sampler.h"
#include "renderer/trace/albedo_table.h"
#include "renderer/trace/fresnel.h"
#include "renderer/trace/ggx_transmission.h"

namespace chiaro::renderer {
namespace {

constexpr int kSamples = 384;
constexpr int kIndices = 10;          // steps in `bending`
constexpr float kMostBending = 0.5F;  // an index of 3
constexpr int kFresnelSteps = 256;    // of the squared cosine

// The root of the reflectance at normal incidence: the same from either side.
float bending(float eta) { return std::abs((eta - 1) / (eta + 1)); }

float outer_index(int step) {
  const float root = kMostBending * float(step) / kIndices;
  return (1 + root) / (1 - root);
}

float integrate_loss(float cosine, float alpha, float eta) {
  const Vec3f wo{std::sqrt(1 - cosine * cosine), 0, cosine};
  float kept = 0;
  for (std::uint32_t k = 0; k < kSamples; ++k) {
    Sampler sampler(1, 0, k);
    const Vec3f h = ggx::sample_visible_normal(wo, alpha, sampler.next_2d());
    const float at_facet = dot(wo, h), reflectance = dielectric_reflectance(at_facet, eta);
    const Vec3f reflected = 2 * at_facet * h - wo, through = ggx::refract(wo, h, eta);
    // f cosθ / pdf without Fresnel: G₂ / G₁.
    if (reflected.z > 0) kept += reflectance * ggx::masking_shadowing(wo.z, reflected.z, alpha);
    if (through.z < 0) kept += (1 - reflectance) * ggx::masking_shadowing(wo.z, -through.z, alpha);
  }
  return std::max(0.0F, 1 - kept / (float(kSamples) * ggx::masking(wo.z, alpha)));
}

float integrate_transmittance(float eta) {
  float sum = 0;
  for (int k = 0; k < kFresnelSteps; ++k) {
    sum += 1 - dielectric_reflectance(std::sqrt((float(k) + 0.5F) / kFresnelSteps), eta);
  }
  return sum / kFresnelSteps;
}

// Of one refractive index.
struct Boundary {
  AlbedoTable<float> loss_outside, loss_inside;
  float transmittance = 0;  // from outside
};

Boundary make_boundary(int step) {
  const auto loss = [](float eta) {
    return make_albedo_table<float>([eta](float cosine, float alpha) { return integrate_loss(cosine, alpha, eta); });
  };
  const float index = outer_index(step);
  return {loss(index), loss(1 / index), integrate_transmittance(index)};
}

const Boundary& boundary(int step) {
  static std::array<std::once_flag, kIndices + 1> once;
  static std::array<Boundary, kIndices + 1> made;
  const auto at = std::size_t(step);
  std::call_once(once[at], [&] { made[at] = make_boundary(step); });
  return made[at];
}

// Between the two nearest indices. of: a value of a boundary.
template <class Of>
float interpolated(float eta, const Of& of) {
  const float place = std::min(bending(eta) / kMostBending, 1.0F) * kIndices;
  const int low = std::min(int(place), kIndices - 1);
  return mix(place - float(low), of(boundary(low)), of(boundary(low + 1)));
}

const AlbedoTable<float>& loss_of(const Boundary& boundary, float eta) {
  return eta < 1 ? boundary.loss_inside : boundary.loss_outside;
}

}  // namespace

float boundary_loss(float cosine, float alpha, float eta) {
  return interpolated(eta, [&](const Boundary& boundary) { return loss_of(boundary, eta).at(cosine, alpha); });
}

float mean_boundary_loss(float alpha, float eta) {
  return interpolated(eta, [&](const Boundary& boundary) { return loss_of(boundary, eta).mean_at(alpha); });
}

// As much light goes out of a solid as into it, from η² of the directions.
float mean_boundary_transmittance(float eta) {
  const float from_outside = interpolated(eta, [](const Boundary& boundary) { return boundary.transmittance; });
  return eta < 1 ? from_outside * eta * eta : from_outside;
}

}  // namespace chiaro::renderer

#pragma once
// Direct illumination of a surface sample by a unity light: V I(ω) cosθ / (π d²), I = 1 cd in every direction, or
// within a spot's cone.

#include <Eigen/Core>
#include <optional>

#include "renderer/trace/light_sampling.h"
#include "renderer/trace/trace_illumination.h"

namespace chiaro::inverse {

// 1 cd everywhere, or on the axis of a cone.
struct UnityLight {
  Eigen::Vector3d position;  // metres
  std::optional<renderer::SpotCone> cone;

  // NOLINTNEXTLINE(google-explicit-constructor): a place is a light that shines everywhere.
  UnityLight(const Eigen::Vector3d& at, std::optional<renderer::SpotCone> within = {}) : position(at), cone(within) {}
};

// Illumination if nothing stands between, cd/m²; 0 below the horizon.
float unoccluded_illumination(const renderer::SurfaceSample& at, renderer::Vec3f light);

struct DirectTerm {
  double value = 0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  // by the light's position, per metre
};
DirectTerm unoccluded_term(const renderer::SurfaceSample& at, const UnityLight& light);

// Whether the light is above the horizon and nothing stands between. seed: as occluded_between.
bool sees(const renderer::RayTracer& tracer, const renderer::SurfaceSample& at, renderer::Vec3f light,
          std::uint32_t seed);
// With what probability it is: the part of the light's direct illumination that arrives.
float visible_part(const renderer::RayTracer& tracer, const renderer::SurfaceSample& at, renderer::Vec3f light);

}  // namespace chiaro::inverse

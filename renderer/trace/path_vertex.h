#pragma once
// What the parts of the path tracer share.

#include "renderer/trace/path_tracer.h"

namespace chiaro::renderer {

// 0 where both are zero or infinite: a point of no measure.
inline float balance_heuristic(float pdf, float other) {
  const float weight = pdf / (pdf + other);
  return weight >= 0 ? weight : 0;
}

// A surface that light is gathered at: either a material's, or a white receiver of which illumination is asked.
struct PathTracer::Vertex {
  Vec3f position;
  Vec3f normal;    // geometric; rays start on its side
  float rounding;  // of position, as SurfacePoint's
  Vec3f to_viewer;
  const Bsdf* bsdf;  // nullptr: a receiver, whose response to irradiance is 1/π
  int index;
  float area_pdf = 0;  // with which scattering at the vertex before found this one, per m²

  // As SurfacePoint's; no lift: rays start at the position whatever their direction.
  Vec3f lift{}, triangle_normal{};

  // Light from below the triangle's horizon that the smooth surface sees: shadow rays start up there.
  bool sees_past_triangle(Vec3f to_light) const {
    return max_component(abs(lift)) > 0 && dot(triangle_normal, to_light) <= 0 && !transmits();
  }

  LightSource punctual = LightSource::kPunctual;  // how punctual lights are to be seen from here
  Vec3f stand_off{};                              // to where a receiver's rays begin
  const Media* media = nullptr;                   // on the viewer's side; nullptr: none
  const Media* behind = nullptr;                  // on the other side, of surfaces that let light through

  const Media* media_towards(Vec3f direction) const { return transmits_to(direction) ? behind : media; }

  Vec3f eval(Vec3f to_light, LightSource source = LightSource::kExtended) const {
    if (bsdf != nullptr) return bsdf->eval(to_viewer, to_light, source);
    const float value = std::max(0.0F, dot(normal, to_light)) * kInvPi;
    return {value, value, value};
  }
  float pdf(Vec3f to_light) const {
    return bsdf != nullptr ? bsdf->pdf(to_viewer, to_light) : std::max(0.0F, dot(normal, to_light)) * kInvPi;
  }
  bool transmits() const { return bsdf != nullptr && bsdf->transmits(); }
  bool transmits_to(Vec3f direction) const { return transmits() && dot(direction, normal) < 0; }
  // Positive where light arrives from that way at all.
  float incident_cosine(Vec3f to_light) const {
    const float cosine = dot(normal, to_light);
    return transmits() ? std::abs(cosine) : cosine;
  }
  // Zero: light from all sides matters.
  Vec3f pick_normal() const { return bsdf == nullptr ? normal : bsdf->light_normal(); }
  Vec3f ray_origin(Vec3f direction) const {
    return offset_point(position + stand_off, transmits_to(direction) ? -normal : normal, rounding);
  }
  // Where a ray from so many metres away ends before it meets the vertex's own surface.
  Vec3f ray_end(float distance) const {
    return offset_point(position, normal, std::max(rounding, surface_rounding(distance, 0)));
  }
};

}  // namespace chiaro::renderer

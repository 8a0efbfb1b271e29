#include "inverse/transport/receiver_samples.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "renderer/core/control.h"
#include "renderer/trace/triangle_extent.h"

namespace chiaro::inverse {
namespace {

using renderer::Box3f;
using renderer::SurfaceSample;
using renderer::Triangle;

constexpr float kNudge = 2e-5F;         // of the part's diagonal; of all receivers' up to the next
constexpr float kMostOfOthers = 2e-4F;  // metres, or twice the rounding of all: off what a part stands on, or against
constexpr float kLeastNudge = 1;        // off the face's edges, in what rounding may take a point off its face
constexpr float kLongestNudge = 0.1F;   // of the way to the centre of the face's inscribed circle

Box3f bounds(std::span<const Vec3f> positions) {
  Box3f box;
  for (const Vec3f& p : positions) box.extend(p);
  return box;
}

Box3f bounds(const Receivers& r, const Receivers::Part& part) {
  return bounds(std::span(r.positions).subspan(part.first_receiver, part.receiver_count));
}

float rounding_of(const Box3f& box) {
  return renderer::surface_rounding(max_component(max(abs(box.min), abs(box.max))), box.diagonal());
}

// A small part's foot is sunk into its floor as rooms are modelled, and beside large ones it is rounded as theirs. But
// a ground of kilometres takes nothing far from its place.
float nudge_of(const Box3f& part, const Box3f& all) {
  const float of_others = std::max(kMostOfOthers, 2 * rounding_of(all));
  return std::max(kNudge * part.diagonal(), std::min(kNudge * all.diagonal(), of_others));
}

struct InscribedCircle {
  Vec3f center;
  float radius = 0;
};

InscribedCircle inscribed_circle(const Receivers& r, const Triangle& face) {
  const Vec3f a = r.positions[face[0]], b = r.positions[face[1]], c = r.positions[face[2]];
  const float bc = length(c - b), ca = length(a - c), ab = length(b - a), around = bc + ca + ab;
  if (!(around > 0)) return {a, 0};
  return {(bc * a + ca * b + ab * c) / around, length(cross(b - a, c - a)) / around};
}

// Off the edges of the vertex's largest face: a neighbouring wall that stands on one of them is behind it.
Vec3f inside_face(const Receivers& r, std::size_t i, const Triangle& face, float nudge, float rounding) {
  const InscribedCircle circle = inscribed_circle(r, face);
  const Vec3f inward = circle.center - r.positions[i];
  const float distance = length(inward), off_edges = kLeastNudge * rounding;
  if (!(distance > 0)) return r.positions[i];
  const float part = std::max(nudge / distance, circle.radius > 0 ? off_edges / circle.radius : kLongestNudge);
  return r.positions[i] + std::min(kLongestNudge, part) * inward;
}

// Of the face, to the side of the vertex's normal.
Vec3f side_of_vertex(const Receivers& r, std::size_t i, const Triangle& face) {
  const Vec3f normal = face_normal(r, face);
  return dot(normal, r.normals[i]) < 0 ? -normal : normal;
}

SurfaceSample sample_of(const Receivers& r, std::size_t i, const Triangle& face, float nudge, float rounding) {
  const Vec3f inside = inside_face(r, i, face, nudge, rounding);
  return {inside + rounding * side_of_vertex(r, i, face), r.normals[i], rounding};
}

// The rounding of the triangles that a point lies on, at rays that meet them straight on; 0: it lies on none.
class RoundingOfScene {
 public:
  explicit RoundingOfScene(const renderer::RayTracer& tracer)
      : tracer_(tracer), most_(kOnTriangle * surface_rounding(renderer::largest_extent(tracer.scene()))) {}

  float at(Vec3f point, Vec3f normal) const {
    float rounding = 0, near = 0;
    for (int met = 0; met < kMostSurfaces; ++met) {
      const auto hit = tracer_.intersect({point + most_ * normal, -normal, near, 2 * most_});
      if (!hit) break;
      const float own = surface_rounding(triangle_extent(tracer_.scene(), *hit));
      if (std::abs(hit->distance - most_) <= kOnTriangle * own) rounding = std::max(rounding, own);
      near = std::nextafter(hit->distance, renderer::kInfinity);
    }
    return rounding;
  }

 private:
  static constexpr float kOnTriangle = 4;   // roundings that a vertex split from a triangle may lie off it
  static constexpr int kMostSurfaces = 16;  // in as thin a layer: coincident ones

  const renderer::RayTracer& tracer_;
  float most_;
};

}  // namespace

std::vector<std::uint32_t> largest_face_per_vertex(const Receivers& r) {
  std::vector<std::uint32_t> face(r.size(), ~0U);
  std::vector<float> area(r.size(), -1);
  for (std::uint32_t t = 0; t < r.triangles.size(); ++t) {
    const auto& [a, b, c] = r.triangles[t];
    const float twice = length(cross(r.positions[b] - r.positions[a], r.positions[c] - r.positions[a]));
    for (const std::uint32_t v : r.triangles[t]) {
      if (twice > area[v]) area[v] = twice, face[v] = t;
    }
  }
  return face;
}

Vec3f face_normal(const Receivers& r, const Triangle& t) {
  const Vec3f area = cross(r.positions[t[1]] - r.positions[t[0]], r.positions[t[2]] - r.positions[t[0]]);
  return length_squared(area) > 0 ? normalize(area) : Vec3f{};
}

void place_samples(Receivers& r) {
  const std::vector<std::uint32_t> face = largest_face_per_vertex(r);
  const Box3f all = bounds(r.positions);
  r.samples.resize(r.size());
  for (const Receivers::Part& part : r.parts) {
    const Box3f box = bounds(r, part);
    const float nudge = nudge_of(box, all), rounding = rounding_of(box);
    for (std::size_t i = part.first_receiver; i < part.first_receiver + part.receiver_count; ++i) {
      r.samples[i] = face[i] == ~0U ? SurfaceSample{r.positions[i], r.normals[i], 0}
                                    : sample_of(r, i, r.triangles[face[i]], nudge, rounding);
    }
  }
}

void place_samples_on(const renderer::RayTracer& tracer, Receivers& r) {
  const RoundingOfScene scene(tracer);
  const std::vector<std::uint32_t> face = largest_face_per_vertex(r);
  const Box3f all = bounds(r.positions);
  std::vector<float> nudges(r.size());
  for (const Receivers::Part& part : r.parts) {
    std::fill_n(nudges.begin() + std::ptrdiff_t(part.first_receiver), part.receiver_count,
                nudge_of(bounds(r, part), all));
  }
  renderer::parallel_for(r.size(), [&](std::size_t i) {
    if (face[i] == ~0U) return;
    const float nudge = nudges[i];
    const Triangle& triangle = r.triangles[face[i]];
    const Vec3f inside = inside_face(r, i, triangle, nudge, r.samples[i].stand_off);
    const Vec3f center = inscribed_circle(r, triangle).center, side = side_of_vertex(r, i, triangle);
    const float rounding = std::max(scene.at(inside, side), scene.at(center, side));
    if (rounding > 0) r.samples[i] = sample_of(r, i, triangle, nudge, rounding);
  });
}

}  // namespace chiaro::inverse

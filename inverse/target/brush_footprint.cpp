#include "inverse/target/brush_footprint.h"

#include <algorithm>

#include "inverse/target/distance_to_path.h"
#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

using Eigen::Vector3d;

constexpr float kFacingCosine = 0.2F;   // between normal and side; `facing` is 1 from here on, and 0 at a cosine of 0
constexpr float kLeastFacing = 1e-3F;   // touched: facing > this
constexpr double kSameDistance = 1e-4;  // on both surfaces: distances differ by ≤ this × radius

using Sides = std::vector<Vec3f>;

// Normals of the surface that a piece of the path lies on: of all triangles that its middle is as near to as to the
// nearest.
Sides sides_of(const ReceiverSurface& surface, const SurfacePath::Piece& piece, double radius) {
  const Vector3d middle = 0.5 * (piece.from + piece.to);
  double nearest = radius;
  visit_near(surface.tree, to_vec3f(middle), nearest, [&](std::uint32_t item) {
    return nearest = std::min(nearest, closest_on_surface(surface, item, middle).distance);
  });
  const double reach = nearest + kSameDistance * radius;
  Sides sides;
  visit_near(surface.tree, to_vec3f(middle), reach, [&](std::uint32_t item) {
    const SurfacePoint found = closest_on_surface(surface, item, middle);
    if (found.distance <= reach) sides.push_back(to_vec3f(found.normal));
    return reach;
  });
  return sides;
}

// And of the pieces before and after it, so that no line is left along the edge that a path crosses aslant.
Sides sides_around(const ReceiverSurface& surface, const SurfacePath& path, std::size_t piece, double radius) {
  Sides sides = sides_of(surface, path.pieces[piece], radius);
  const auto add_joined = [&](std::size_t first, std::size_t second, std::size_t other) {
    if ((path.pieces[first].to - path.pieces[second].from).norm() > kSameDistance * radius) return;
    const Sides more = sides_of(surface, path.pieces[other], radius);
    sides.insert(sides.end(), more.begin(), more.end());
  };
  if (piece > 0) add_joined(piece - 1, piece, piece - 1);
  if (piece + 1 < path.pieces.size()) add_joined(piece, piece + 1, piece + 1);
  return sides;
}

// A step at some cosine would show the receivers' triangles in the picture.
float facing(Vec3f normal, const Sides& sides) {
  float cosine = 0;
  for (const Vec3f side : sides) cosine = std::max(cosine, dot(normal, side));
  const float t = std::min(cosine / kFacingCosine, 1.0F);
  return t * t * (3 - 2 * t);
}

Vec3f mirrored(Vec3f point, const MirrorPlane& plane) {
  return point - 2 * dot(point - plane.point, plane.normal) * plane.normal;
}

SurfacePath lay_mirror_image(const ReceiverSurface& surface, const Stroke& stroke, const renderer::Control& control) {
  if (!stroke.mirror) return {};
  std::vector<Vec3f> image;
  for (const Vec3f point : stroke.path) image.push_back(mirrored(point, *stroke.mirror));
  return lay_on_surface(surface, image, stroke.radius, control);
}

std::vector<PathDistance> distances(const ReceiverSurface& surface, const SurfacePath& path, const Stroke& stroke,
                                    const renderer::Control& control) {
  const bool along_surface = stroke.distance == BrushDistance::kSurface && !surface.receivers.triangles.empty();
  return along_surface ? distances_along_surface(surface, path, stroke.radius, control)
                       : distances_through_space(surface, path, stroke.radius, control);
}

}  // namespace

BrushFootprint brush_footprint(const ReceiverSurface& surface, const Stroke& stroke, const renderer::Control& control) {
  SurfacePath path = lay_on_surface(surface, stroke.path, stroke.radius, control);
  SurfacePath image = lay_mirror_image(surface, stroke, control);
  path.pieces.insert(path.pieces.end(), image.pieces.begin(), image.pieces.end());
  std::vector<Sides> sides(path.pieces.size());
  BrushFootprint footprint{{}, path.far_points, std::move(image.far_points)};
  for (const PathDistance& near : distances(surface, path, stroke, control)) {
    Sides& side = sides[near.piece];
    if (stroke.facing && side.empty()) side = sides_around(surface, path, near.piece, stroke.radius);
    const float faced = stroke.facing ? facing(surface.receivers.normals[near.receiver], side) : 1;
    if (faced > kLeastFacing) footprint.touched.push_back({near.receiver, float(near.distance), faced});
  }
  return footprint;
}

}  // namespace chiaro::inverse

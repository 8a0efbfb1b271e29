#include "inverse/numerics/two_sided_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include <Eigen/Geometry>

namespace chiaro::inverse::numerics {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;
constexpr double kThickness = 1e-3;  // radians that a face lies in front of another in the same place

// A face at an edge.
struct Wing {
  std::uint32_t face = 0, corner = 0;  // whose edge it is
  Vector3d inward, front;              // unit, perpendicular to the edge: into the face, and its normal
};

struct WingSide {
  std::size_t wing = 0;
  bool front = true;
};

// What somebody on a side of a wing meets first on turning round the edge.
WingSide first_met(std::span<const Wing> wings, WingSide from) {
  const Wing& start = wings[from.wing];
  const Vector3d up = from.front ? start.front : Vector3d(-start.front);
  WingSide met = from;
  double least = 3 * kPi;
  for (std::size_t i = 0; i < wings.size(); ++i) {
    if (i == from.wing) continue;
    const double angle = std::atan2(wings[i].inward.dot(up), wings[i].inward.dot(start.inward));
    const Vector3d turning = -std::sin(angle) * start.inward + std::cos(angle) * up;
    const bool faces_us = wings[i].front.dot(turning) < 0;
    double turned = angle + (faces_us ? -kThickness : kThickness) + (from.front ? -kThickness : kThickness);
    if (turned <= 0) turned += 2 * kPi;
    if (turned < least) least = turned, met = {i, faces_us};
  }
  return met;
}

class Builder {
 public:
  explicit Builder(const JoinedFaces& joined) : joined_(joined) {}

  TwoSidedSurface build() {
    make_frames();
    make_corners();
    glue_edges();
    number_vertices();
    return std::move(result_);
  }

 private:
  const Vector3d& place(std::uint32_t point) const { return joined_.points[point]; }
  std::uint32_t face_count() const { return std::uint32_t(joined_.faces.size()); }

  void make_frames() {
    for (const JoinedFaces::Face& face : joined_.faces) {
      Vector3d normal = Vector3d::Zero(), longest = Vector3d::Zero();
      for (std::size_t k = 0; k < face.points.size(); ++k) {
        const Vector3d a = place(face.points[k]) - place(face.points[0]);
        const Vector3d b = place(face.points[(k + 1) % face.points.size()]) - place(face.points[0]);
        normal += a.cross(b);
        if ((b - a).squaredNorm() > longest.squaredNorm()) longest = b - a;
      }
      const Vector3d x = (longest - longest.dot(normal) / normal.squaredNorm() * normal).normalized();
      result_.frames.push_back({place(face.points[0]), x, normal.normalized().cross(x)});
    }
  }

  void make_corners() {
    FlatSurface& surface = result_.surface;
    for (std::uint32_t f = 0; f < face_count(); ++f) {
      surface.face_begin.push_back(std::uint32_t(surface.corners.size()));
      for (const std::uint32_t point : joined_.faces[f].points) {
        surface.corners.push_back({result_.frames[f].flat(place(point)), 0, kNoCorner});
      }
    }
    for (std::uint32_t f = 0; f < face_count(); ++f) {
      surface.face_begin.push_back(std::uint32_t(surface.corners.size()));
      for (std::size_t k = joined_.faces[f].points.size(); k-- > 0;) {
        const Eigen::Vector2d flat = surface.corners[surface.face_begin[f] + k].place;
        surface.corners.push_back({{flat.x(), -flat.y()}, 0, kNoCorner});
      }
    }
    surface.face_begin.push_back(std::uint32_t(surface.corners.size()));
  }

  // The corner of a side that the edge from the front's corner k starts at there.
  std::uint32_t edge_corner(const Wing& wing, bool front) const {
    const auto count = std::uint32_t(joined_.faces[wing.face].points.size());
    if (front) return result_.surface.face_begin[wing.face] + wing.corner;
    return result_.surface.face_begin[wing.face + face_count()] + (2 * count - 2 - wing.corner) % count;
  }

  Wing make_wing(std::uint32_t face, std::uint32_t corner) const {
    const JoinedFaces::Face& f = joined_.faces[face];
    const TwoSidedSurface::Frame& frame = result_.frames[face];
    const Vector3d along = (place(f.points[(corner + 1) % f.points.size()]) - place(f.points[corner])).normalized();
    const Vector3d inward = frame.x.cross(frame.y).cross(along).normalized();
    return {face, corner, inward, along.cross(inward)};
  }

  void glue_edges() {
    using Edge = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
    std::vector<Edge> edges;
    for (std::uint32_t f = 0; f < face_count(); ++f) {
      const auto& points = joined_.faces[f].points;
      for (std::uint32_t k = 0; k < points.size(); ++k) {
        const auto [low, high] = std::minmax(points[k], points[(k + 1) % points.size()]);
        edges.push_back({low, high, f, k});
      }
    }
    std::sort(edges.begin(), edges.end());
    std::vector<Wing> wings;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const auto& [low, high, face, corner] = edges[i];
      wings.push_back(make_wing(face, corner));
      const bool last = i + 1 == edges.size() || std::get<0>(edges[i + 1]) != low || std::get<1>(edges[i + 1]) != high;
      if (last) glue(wings), wings.clear();
    }
  }

  void glue(std::span<const Wing> wings) {
    for (std::size_t i = 0; i < wings.size(); ++i) {
      for (const bool front : {true, false}) {
        const WingSide met = first_met(wings, {i, front});
        const WingSide back = first_met(wings, met);
        if (met.wing == i || back.wing != i || back.front != front) continue;
        result_.surface.corners[edge_corner(wings[i], front)].opposite = edge_corner(wings[met.wing], met.front);
      }
    }
  }

  // A vertex is what corners are joined to around it.
  void number_vertices() {
    FlatSurface& surface = result_.surface;
    parent_.resize(surface.corners.size());
    std::iota(parent_.begin(), parent_.end(), 0U);
    for (std::uint32_t f = 0; f < surface.face_count(); ++f) {
      for (std::uint32_t c = surface.face_begin[f]; c < surface.face_begin[f + 1]; ++c) {
        if (surface.corners[c].opposite != kNoCorner) join(c, next(surface.corners[c].opposite));
      }
    }
    std::vector<std::uint32_t> number(parent_.size(), kNoCorner);
    for (std::uint32_t c = 0; c < parent_.size(); ++c) {
      std::uint32_t& vertex = number[root(c)];
      if (vertex == kNoCorner) vertex = surface.vertex_count++;
      surface.corners[c].vertex = vertex;
    }
  }

  std::uint32_t next(std::uint32_t corner) const {
    const std::vector<std::uint32_t>& begin = result_.surface.face_begin;
    const auto end = std::upper_bound(begin.begin(), begin.end(), corner);
    return corner + 1 == *end ? *(end - 1) : corner + 1;
  }

  std::uint32_t root(std::uint32_t corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }

  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

  const JoinedFaces& joined_;
  TwoSidedSurface result_;
  std::vector<std::uint32_t> parent_;
};

}  // namespace

TwoSidedSurface make_two_sided(const JoinedFaces& joined) { return Builder(joined).build(); }

}  // namespace chiaro::inverse::numerics

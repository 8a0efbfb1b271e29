#pragma once
// Triangles made in code, as a surface to measure distances on.

#include <cmath>
#include <random>

#include <Eigen/Geometry>

#include "inverse/numerics/two_sided_surface.h"

namespace chiaro::inverse::numerics::tests {

using Eigen::Vector3d;

struct Soup {
  std::vector<Vector3d> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  TriangleCorners corners(std::size_t t) const {
    return {positions[triangles[t][0]], positions[triangles[t][1]], positions[triangles[t][2]]};
  }

  void append(const Soup& other) {
    const auto first = std::uint32_t(positions.size());
    positions.insert(positions.end(), other.positions.begin(), other.positions.end());
    for (const auto& t : other.triangles) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
};

// (columns + 1) × (rows + 1) places of a function of two parameters from 0 to 1; those inside are moved by up to
// `jitter` of a cell, and cells have either diagonal. Its front is that of u × v.
template <class Place>
Soup make_sheet(int columns, int rows, double jitter, const Place& place) {
  std::mt19937 random(7);
  const auto shift = [&] { return jitter * (double(random()) / double(std::mt19937::max()) - 0.5); };
  Soup soup;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const double u = i + (i > 0 && i < columns ? shift() : 0), v = j + (j > 0 && j < rows ? shift() : 0);
      soup.positions.push_back(place(u / columns, v / rows));
    }
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const auto a = std::uint32_t(j * (columns + 1) + i), b = a + 1, c = a + std::uint32_t(columns) + 1, d = c + 1;
      if (jitter > 0 && random() % 2 == 0) {
        soup.triangles.insert(soup.triangles.end(), {{a, b, c}, {b, d, c}});
      } else {
        soup.triangles.insert(soup.triangles.end(), {{a, b, d}, {a, d, c}});
      }
    }
  }
  return soup;
}

inline Soup make_flat_sheet(const Vector3d& origin, const Vector3d& u, const Vector3d& v, int columns, int rows,
                            double jitter = 0) {
  return make_sheet(columns, rows, jitter, [&](double s, double t) -> Vector3d { return origin + s * u + t * v; });
}

struct WalkableSurface {
  JoinedFaces joined;
  TwoSidedSurface sides;

  // The fronts of faces that `p` lies on.
  std::vector<GeodesicSource> sources_at(const Vector3d& from, const Vector3d& to, double tolerance) const {
    std::vector<GeodesicSource> sources;
    for (std::uint32_t f = 0; f < joined.faces.size(); ++f) {
      const TwoSidedSurface::Frame& frame = sides.frames[f];
      const Vector3d normal = frame.x.cross(frame.y);
      const bool in_plane =
          std::max(std::abs(normal.dot(from - frame.origin)), std::abs(normal.dot(to - frame.origin))) <= tolerance;
      if (in_plane) append_clipped(f, frame.flat(from), frame.flat(to), tolerance, sources);
    }
    return sources;
  }

  void append_clipped(std::uint32_t f, Eigen::Vector2d from, Eigen::Vector2d to, double tolerance,
                      std::vector<GeodesicSource>& sources) const {
    const Eigen::Vector2d start = from, along = to - from;
    double first = 0, last = 1;
    for (std::uint32_t c = sides.surface.face_begin[f]; c < sides.surface.face_begin[f + 1]; ++c) {
      const Eigen::Vector2d& a = sides.surface.corners[c].place;
      const std::uint32_t next = c + 1 < sides.surface.face_begin[f + 1] ? c + 1 : sides.surface.face_begin[f];
      const Eigen::Vector2d edge = (sides.surface.corners[next].place - a).normalized(), inward(-edge.y(), edge.x());
      const double here = inward.dot(start - a) + tolerance, rate = inward.dot(along);
      if (rate == 0 && here < 0) return;
      if (rate > 0) first = std::max(first, -here / rate);
      if (rate < 0) last = std::min(last, -here / rate);
    }
    if (first <= last) sources.push_back({f, start + first * along, start + last * along, 0});
  }

  // Of every position on the front of its triangles, which are those of `soup`.
  std::vector<double> distances(const Soup& soup, const std::vector<GeodesicSource>& sources, double reach) const {
    const auto of_vertex = geodesic_distance(sides.surface, sources, reach);
    std::vector<double> result(soup.positions.size(), std::numeric_limits<double>::infinity());
    for (std::uint32_t f = 0; f < joined.faces.size(); ++f) {
      for (std::size_t k = 0; k < joined.faces[f].points.size(); ++k) {
        const auto vertex = sides.surface.corners[sides.surface.face_begin[f] + k].vertex;
        for (const std::uint32_t position : soup.triangles[joined.faces[f].triangle]) {
          if (joined.point_of[position] != joined.faces[f].points[k]) continue;
          result[position] = std::min(result[position], of_vertex[vertex].distance);
        }
      }
    }
    return result;
  }
};

// With contacts between all pairs, of few triangles.
inline WalkableSurface make_walkable(const Soup& soup, const JoinTolerances& tolerances = {1e-6, 1e-3}) {
  std::vector<TriangleContact> contacts;
  for (std::uint32_t a = 0; a < soup.triangles.size() && soup.triangles.size() < 1000; ++a) {
    for (std::uint32_t b = a + 1; b < soup.triangles.size(); ++b) {
      int same = 0;
      for (const Vector3d& p : soup.corners(a)) {
        for (const Vector3d& q : soup.corners(b)) same += (p - q).norm() <= tolerances.same_point;
      }
      if (same >= 2) continue;
      if (const auto contact = surface_contact(soup.corners(a), soup.corners(b), tolerances.contact)) {
        contacts.push_back({a, b, *contact});
      }
    }
  }
  WalkableSurface surface{join_faces(soup.positions, soup.triangles, contacts, tolerances), {}};
  surface.sides = make_two_sided(surface.joined);
  return surface;
}

inline std::vector<double> distances_to(const Soup& soup, const Vector3d& from, const Vector3d& to, double reach) {
  const WalkableSurface surface = make_walkable(soup);
  return surface.distances(soup, surface.sources_at(from, to, 1e-5), reach);
}

}  // namespace chiaro::inverse::numerics::tests

#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace chiaro::inverse::numerics {

inline constexpr std::uint32_t kNoCorner = ~0U;

// One side of a surface of flat convex faces, glued along whole edges. Every vertex is the tip of one fan of faces,
// closed or open: where several fans meet in a point it is several vertices.
struct FlatSurface {
  struct Corner {
    Eigen::Vector2d place;               // in the plane of its face, each face in coordinates of its own
    std::uint32_t vertex = 0;            // number among the surface's vertices
    std::uint32_t opposite = kNoCorner;  // whose edge is this corner's edge, in the other direction; or an open edge
  };
  std::vector<Corner> corners;            // face by face, counter-clockwise; a corner's edge runs to the next one
  std::vector<std::uint32_t> face_begin;  // first corner of each face, and the number of corners
  std::uint32_t vertex_count = 0;

  std::uint32_t face_count() const { return std::uint32_t(face_begin.size()) - 1; }
};

// A segment in a face, or a point where both ends are the same. What lies on an edge is a source in both faces.
struct GeodesicSource {
  std::uint32_t face = 0;
  Eigen::Vector2d from, to;
  std::uint32_t origin = 0;  // any number
};

struct GeodesicDistance {
  double distance = std::numeric_limits<double>::infinity();
  std::uint32_t origin = 0;  // of the source it is measured to
};

// The length of the shortest way on the surface from each vertex to the sources, up to `reach`; infinite beyond. Exact
// up to rounding as long as edges are long; where windows have become narrower than 1/500 of the reach, vertices take
// over, each from two of a face. Only faces within reach are visited.
// Source: Xin & Wang, Improving Chen and Han's algorithm on the discrete geodesic problem, 2009; for vertices, Novotni
// & Klein, Computing geodesic distances on triangular meshes, 2002.
std::vector<GeodesicDistance> geodesic_distance(const FlatSurface& surface, std::span<const GeodesicSource> sources,
                                                double reach);

}  // namespace chiaro::inverse::numerics

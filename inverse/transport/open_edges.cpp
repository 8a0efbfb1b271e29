#include "inverse/transport/open_edges.h"

#include <algorithm>
#include <cstdint>

namespace chiaro::inverse {
namespace {

using renderer::Vec3f;

std::array<float, 3> key_of(const Vec3f& p) { return {p.x, p.y, p.z}; }

// Each corner's number: its place among all coordinates there are.
std::vector<std::array<std::uint32_t, 3>> numbered_corners(std::span<const WorldCorners> triangles) {
  std::vector<std::array<float, 3>> places;
  places.reserve(3 * triangles.size());
  for (const WorldCorners& corners : triangles) {
    for (const Vec3f& corner : corners) places.push_back(key_of(corner));
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<std::array<std::uint32_t, 3>> numbers(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const auto place = std::lower_bound(places.begin(), places.end(), key_of(triangles[t][k]));
      numbers[t][k] = std::uint32_t(place - places.begin());
    }
  }
  return numbers;
}

}  // namespace

std::vector<OpenEdges> find_open_edges(std::span<const WorldCorners> triangles) {
  struct Edge {
    std::array<std::uint32_t, 2> corners;  // the lower number first
    std::uint32_t triangle;
    int k;
  };
  const auto numbers = numbered_corners(triangles);
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(numbers[t][(k + 1) % 3], numbers[t][(k + 2) % 3]);
      edges.push_back({{a, b}, t, k});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.corners < b.corners; });

  std::vector<OpenEdges> open(triangles.size());
  std::vector<bool> open_corner(3 * triangles.size());
  for (auto edge = edges.begin(); edge != edges.end();) {
    const auto next = std::find_if(edge, edges.end(), [&](const Edge& e) { return e.corners != edge->corners; });
    if (next - edge == 1) {
      open[edge->triangle].edge[edge->k] = true;
      for (const auto corner : edge->corners) open_corner[corner] = true;
    }
    edge = next;
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) open[t].corner[k] = open_corner[numbers[t][k]];
  }
  return open;
}

}  // namespace chiaro::inverse

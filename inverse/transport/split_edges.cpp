#include "inverse/transport/split_edges.h"

#include <unordered_map>

namespace chiaro::inverse {
namespace {

using renderer::Triangle;
using renderer::Vec3f;

constexpr std::uint32_t kNone = ~0U;

// New vertices in the middle of edges, by the numbers of the edge's ends.
class Midpoints {
 public:
  Midpoints(SurfaceMesh& mesh, float max_edge) : mesh_(mesh), max_squared_(max_edge * max_edge) {}

  std::uint32_t of(std::uint32_t a, std::uint32_t b) {
    if (!(length_squared(mesh_.positions[a] - mesh_.positions[b]) > max_squared_)) return kNone;
    const std::uint64_t key = (std::uint64_t(std::min(a, b)) << 32) | std::max(a, b);
    const auto [found, added] = middle_.try_emplace(key, std::uint32_t(mesh_.positions.size()));
    if (added) {
      mesh_.positions.push_back(0.5F * (mesh_.positions[a] + mesh_.positions[b]));
      const Vec3f n = mesh_.normals[a] + mesh_.normals[b];
      mesh_.normals.push_back(length_squared(n) > 1e-12F ? normalize(n) : mesh_.normals[a]);
    }
    return found->second;
  }

 private:
  SurfaceMesh& mesh_;
  float max_squared_;
  std::unordered_map<std::uint64_t, std::uint32_t> middle_;
};

// Turned so that the edges to split come first: one split edge is (0, 1); of two, the unsplit one is (2, 0).
void rotate_to_canonical(Triangle& t, std::array<std::uint32_t, 3>& m) {
  const int split = (m[0] != kNone) + (m[1] != kNone) + (m[2] != kNone);
  for (int turn = 0; turn < 2; ++turn) {
    if (split == 1 ? m[0] != kNone : m[2] == kNone) return;
    t = {t[1], t[2], t[0]};
    m = {m[1], m[2], m[0]};
  }
}

void emit(Triangle t, std::array<std::uint32_t, 3> m, const SurfaceMesh& mesh, std::vector<Triangle>& out) {
  const int split = (m[0] != kNone) + (m[1] != kNone) + (m[2] != kNone);
  if (split == 1 || split == 2) rotate_to_canonical(t, m);
  const auto& [a, b, c] = t;
  if (split == 0) {
    out.push_back(t);
  } else if (split == 1) {
    out.insert(out.end(), {Triangle{a, m[0], c}, Triangle{m[0], b, c}});
  } else if (split == 2) {
    out.push_back({m[0], b, m[1]});
    // The quadrilateral a, m0, m1, c is cut along its shorter diagonal.
    const bool from_a = length_squared(mesh.positions[a] - mesh.positions[m[1]]) <=
                        length_squared(mesh.positions[m[0]] - mesh.positions[c]);
    if (from_a) {
      out.insert(out.end(), {Triangle{a, m[0], m[1]}, Triangle{a, m[1], c}});
    } else {
      out.insert(out.end(), {Triangle{a, m[0], c}, Triangle{m[0], m[1], c}});
    }
  } else {
    out.insert(out.end(),
               {Triangle{a, m[0], m[2]}, Triangle{m[0], b, m[1]}, Triangle{m[2], m[1], c}, Triangle{m[0], m[1], m[2]}});
  }
}

}  // namespace

void split_long_edges(SurfaceMesh& mesh, float max_edge) {
  for (bool changed = true; changed;) {
    Midpoints midpoints(mesh, max_edge);
    std::vector<Triangle> out;
    out.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
      emit(t, {midpoints.of(t[0], t[1]), midpoints.of(t[1], t[2]), midpoints.of(t[2], t[0])}, mesh, out);
    }
    changed = out.size() != mesh.triangles.size();
    mesh.triangles = std::move(out);
  }
}

double estimated_vertices_after_split(const SurfaceMesh& mesh, float max_edge) {
  double added = 0;
  for (const Triangle& t : mesh.triangles) {
    double pieces = 1;
    float edges[3];
    for (int k = 0; k < 3; ++k) edges[k] = length(mesh.positions[t[k]] - mesh.positions[t[(k + 1) % 3]]);
    std::sort(edges, edges + 3);
    // Halved until short enough: the longest edge and the next each multiply the triangles by their number of pieces.
    for (int k = 1; k < 3; ++k) {
      if (edges[k] > max_edge) pieces *= std::exp2(std::ceil(std::log2(edges[k] / max_edge)));
    }
    added += 0.5 * (pieces - 1);
  }
  return double(mesh.positions.size()) + added;
}

}  // namespace chiaro::inverse

#include "inverse/transport/split_edges.h"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <utility>

namespace chiaro::inverse {
namespace {

using renderer::Triangle;
using renderer::Vec3f;

constexpr std::uint32_t kNone = ~0U;

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return (std::uint64_t(std::min(a, b)) << 32) | std::max(a, b);
}

// New vertices in the middle of edges, by the numbers of the edge's ends.
class Midpoints {
 public:
  Midpoints(SurfaceMesh& mesh, float max_edge) : mesh_(mesh), max_squared_(max_edge * max_edge) {}

  std::uint32_t of(std::uint32_t a, std::uint32_t b) {
    const Vec3f from = mesh_.positions[a], to = mesh_.positions[b], middle = 0.5F * (from + to);
    const float squared = length_squared(from - to);
    if (!(squared > max_squared_)) return kNone;
    // Ends that are neighbours among floats have nothing between them, and would be split for ever.
    constexpr float kLongestHalf = 0.75F * 0.75F;
    if (std::max(length_squared(middle - from), length_squared(middle - to)) > kLongestHalf * squared) return kNone;
    const auto [found, added] = middle_.try_emplace(edge_key(a, b), std::uint32_t(mesh_.positions.size()));
    if (added) {
      mesh_.positions.push_back(middle);
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

// Squared lengths of a triangle's edges; edge k joins corners k and k + 1. How it is split depends on them alone.
using EdgeLengths = std::array<double, 3>;
using LongEdge = std::pair<std::uint64_t, double>;  // key and squared length

// Of double precision, so that no mesh of finite floats overflows.
double squared_distance(Vec3f a, Vec3f b) {
  const double x = double(a.x) - b.x, y = double(a.y) - b.y, z = double(a.z) - b.z;
  return x * x + y * y + z * z;
}

EdgeLengths edge_lengths(const SurfaceMesh& mesh, const Triangle& t) {
  const Vec3f a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
  return {squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)};
}

// From the corner opposite to the middle of a side; Apollonius' theorem.
double squared_median(double side, double other, double another) {
  return std::max(0.0, (2 * other + 2 * another - side) / 4);
}

struct SplitCounter {
  double max_squared;

  bool is_long(double squared_length) const { return squared_length > max_squared; }

  double on_edge(double squared_length) const {
    double pieces = 1;
    for (; is_long(squared_length); squared_length /= 4) pieces *= 2;
    return pieces - 1;
  }

  // Of two pieces of a triangle: on the seam between them, and inside either.
  double on_and_beside(double seam, const EdgeLengths& one, const EdgeLengths& other, double limit) const {
    double count = on_edge(seam) + inside(one, limit);
    if (count <= limit) count += inside(other, limit - count);
    return count;
  }

  // In the cases and the order of `emit`.
  double inside(EdgeLengths e, double limit) const {
    const int split = is_long(e[0]) + is_long(e[1]) + is_long(e[2]);
    if (split == 0) return 0;
    const auto is_canonical = [&] { return split == 3 || (split == 1 ? is_long(e[0]) : !is_long(e[2])); };
    while (!is_canonical()) e = {e[1], e[2], e[0]};
    const EdgeLengths half{e[0] / 4, e[1] / 4, e[2] / 4};
    if (split == 3) return on_edge(half[0]) + on_edge(half[1]) + on_edge(half[2]) + 4 * inside(half, limit / 4);
    const double from_c = squared_median(e[0], e[1], e[2]), from_a = squared_median(e[1], e[2], e[0]);
    if (split == 1) return on_and_beside(from_c, {half[0], from_c, e[2]}, {half[0], e[1], from_c}, limit);
    const double tip = inside(half, limit);
    if (from_a <= from_c)
      return tip + on_and_beside(from_a, {half[0], half[2], from_a}, {from_a, half[1], e[2]}, limit);
    return tip + on_and_beside(from_c, {half[0], from_c, e[2]}, {half[2], half[1], from_c}, limit);
  }
};

}  // namespace

void split_long_edges(SurfaceMesh& mesh, float max_edge, const renderer::Control& control) {
  // More than floats have binary places between the longest edge and the shortest; rounding may keep edges long for
  // ever.
  constexpr int kPasses = 64;
  bool changed = true;
  for (int pass = 0; changed && pass < kPasses; ++pass) {
    Midpoints midpoints(mesh, max_edge);
    std::vector<Triangle> out;
    out.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
      control.stop_if_requested();
      emit(t, {midpoints.of(t[0], t[1]), midpoints.of(t[1], t[2]), midpoints.of(t[2], t[0])}, mesh, out);
    }
    changed = out.size() != mesh.triangles.size();
    mesh.triangles = std::move(out);
  }
}

double vertices_after_split(const SurfaceMesh& mesh, float max_edge, double limit) {
  const SplitCounter counter{double(max_edge) * double(max_edge)};
  double count = double(mesh.positions.size());
  std::vector<LongEdge> long_edges;
  for (const Triangle& t : mesh.triangles) {
    const EdgeLengths edges = edge_lengths(mesh, t);
    for (int k = 0; k < 3; ++k) {
      if (counter.is_long(edges[k])) long_edges.push_back({edge_key(t[k], t[(k + 1) % 3]), edges[k]});
    }
    count += counter.inside(edges, limit - count);
    if (count > limit) return count;
  }
  std::sort(long_edges.begin(), long_edges.end());
  long_edges.erase(std::unique(long_edges.begin(), long_edges.end()), long_edges.end());
  for (const auto& [key, squared_length] : long_edges) count += counter.on_edge(squared_length);
  return count;
}

}  // namespace chiaro::inverse

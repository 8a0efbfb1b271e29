// Notation: a face is a triangle, `s` and `t` its texture coordinates; os and ot the directions in which they grow;
// a group is the faces around a vertex that share its tangent, which is their angle-weighted mean.

#include "renderer/io/mikktspace.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <tuple>
#include <unordered_map>

namespace chiaro::renderer {
namespace {

constexpr int kNone = -1;

bool not_zero(float x) { return std::abs(x) > FLT_MIN; }

Vec3f unit_or_as_is(Vec3f v) {
  const float l = length(v);
  return not_zero(v.x) || not_zero(v.y) || not_zero(v.z) ? v / l : v;
}

Vec3f on_plane(Vec3f v, Vec3f normal) { return unit_or_as_is(v - dot(normal, v) * normal); }

struct Face {
  std::array<std::uint32_t, 3> corners{};             // welded vertices
  std::array<int, 3> neighbors{kNone, kNone, kNone};  // across the edge from corner i to corner i + 1
  std::array<int, 3> groups{kNone, kNone, kNone};
  Vec3f os, ot;
  bool keeps_orientation = false;  // s and t turn the same way as the corners
  bool any_group = true;           // its coordinates have no direction of their own
  bool degenerate = false;         // two of its corners are one point
};

struct Group {
  std::uint32_t vertex = 0;
  bool keeps_orientation = false;
  std::vector<int> faces;
};

struct Edge {
  std::uint32_t low = 0, high = 0;
  int face = 0, side = 0;
  bool operator<(const Edge& other) const {
    return std::tie(low, high, face, side) < std::tie(other.low, other.high, other.face, other.side);
  }
};

int corner_of(const Face& face, std::uint32_t vertex) {
  return face.corners[0] == vertex ? 0 : face.corners[1] == vertex ? 1 : 2;
}

class TangentSpaces {
 public:
  TangentSpaces(const std::vector<Vec3f>& positions, const std::vector<Vec3f>& normals, const std::vector<Vec2f>& uv,
                const std::vector<Triangle>& triangles)
      : positions_(positions), normals_(normals), uv_(uv) {
    make_faces(triangles, welded_vertices());
    find_neighbors();
    make_groups();
  }

  std::vector<Vec4f> corner_tangents() const {
    std::vector<Vec4f> tangents(3 * faces_.size(), Vec4f{1, 0, 0, -1});
    std::vector<int> set_at(positions_.size(), kNone);  // by welded vertex: a corner that has its tangent
    for (const Group& group : groups_) {
      for (const int f : group.faces) {
        const int c = corner_of(faces_[std::size_t(f)], group.vertex);
        const Vec3f t = tangent(group, f);
        tangents[std::size_t(3 * f + c)] = {t.x, t.y, t.z, group.keeps_orientation ? 1.0F : -1.0F};
        set_at[group.vertex] = 3 * f + c;
      }
    }
    // Degenerate faces take what another face has at the same vertex.
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      for (std::size_t c = 0; faces_[f].degenerate && c < 3; ++c) {
        const int from = set_at[faces_[f].corners[c]];
        if (from != kNone) tangents[3 * f + c] = tangents[std::size_t(from)];
      }
    }
    return tangents;
  }

 private:
  using Key = std::array<float, 8>;

  struct KeyHash {
    std::size_t operator()(const Key& key) const {
      std::uint64_t hash = 14695981039346656037ULL;
      for (const float value : key) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * 1099511628211ULL;
      }
      return std::size_t(hash ^ hash >> 29);
    }
  };

  // Per vertex the first one that is the same.
  std::vector<std::uint32_t> welded_vertices() const {
    std::unordered_map<Key, std::uint32_t, KeyHash> first;
    first.reserve(positions_.size());
    std::vector<std::uint32_t> welded(positions_.size());
    for (std::uint32_t v = 0; v < welded.size(); ++v) {
      const Vec3f p = positions_[v], n = normals_[v];
      Key key{p.x, p.y, p.z, n.x, n.y, n.z, uv_[v].x, uv_[v].y};
      for (float& value : key) value += 0.0F;  // -0 is 0
      welded[v] = first.try_emplace(key, v).first->second;
    }
    return welded;
  }

  void make_faces(const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& welded) {
    faces_.reserve(triangles.size());
    for (const Triangle& t : triangles) {
      Face face;
      face.corners = {welded[t[0]], welded[t[1]], welded[t[2]]};
      set_directions(face);
      faces_.push_back(face);
    }
  }

  void set_directions(Face& face) const {
    const auto [a, b, c] = face.corners;
    const Vec3f d1 = positions_[b] - positions_[a], d2 = positions_[c] - positions_[a];
    face.degenerate = d1 == Vec3f{} || d2 == Vec3f{} || positions_[b] == positions_[c];
    const float s1 = uv_[b].x - uv_[a].x, t1 = uv_[b].y - uv_[a].y;
    const float s2 = uv_[c].x - uv_[a].x, t2 = uv_[c].y - uv_[a].y;
    const float area = s1 * t2 - t1 * s2;
    face.keeps_orientation = area > 0;
    if (!not_zero(area)) return;
    const Vec3f os = t2 * d1 - t1 * d2, ot = s1 * d2 - s2 * d1;
    const float os_length = length(os), ot_length = length(ot), sign = face.keeps_orientation ? 1.0F : -1.0F;
    if (not_zero(os_length)) face.os = (sign / os_length) * os;
    if (not_zero(ot_length)) face.ot = (sign / ot_length) * ot;
    face.any_group = !(not_zero(os_length / std::abs(area)) && not_zero(ot_length / std::abs(area)));
  }

  void find_neighbors() {
    std::vector<Edge> edges;
    edges.reserve(3 * faces_.size());
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      for (std::size_t c = 0; !faces_[f].degenerate && c < 3; ++c) {
        const std::uint32_t from = faces_[f].corners[c], to = faces_[f].corners[(c + 1) % 3];
        edges.push_back({std::min(from, to), std::max(from, to), int(f), int(c)});
      }
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      for (std::size_t j = i + 1; neighbor(edges[i]) == kNone && j < edges.size() && same_ends(edges[i], edges[j]);
           ++j) {
        if (neighbor(edges[j]) != kNone || from(edges[i]) == from(edges[j])) continue;
        neighbor(edges[i]) = edges[j].face;
        neighbor(edges[j]) = edges[i].face;
      }
    }
  }

  static bool same_ends(const Edge& a, const Edge& b) { return a.low == b.low && a.high == b.high; }
  int& neighbor(const Edge& e) { return faces_[std::size_t(e.face)].neighbors[std::size_t(e.side)]; }
  std::uint32_t from(const Edge& e) const { return faces_[std::size_t(e.face)].corners[std::size_t(e.side)]; }

  void make_groups() {
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (faces_[f].degenerate) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        if (faces_[f].any_group || faces_[f].groups[c] != kNone) continue;
        groups_.push_back({faces_[f].corners[c], faces_[f].keeps_orientation, {}});
        grow_group(int(f));
      }
    }
  }

  // Depth first, across the edge after the vertex before that in front of it.
  void grow_group(int first) {
    const int g = int(groups_.size()) - 1;
    Group& group = groups_.back();
    std::vector<int> waiting{first};
    while (!waiting.empty()) {
      const int f = waiting.back();
      waiting.pop_back();
      Face& face = faces_[std::size_t(f)];
      const auto c = std::size_t(corner_of(face, group.vertex));
      if (face.groups[c] != kNone) continue;
      const bool free = face.groups == std::array{kNone, kNone, kNone};
      if (face.any_group && free) face.keeps_orientation = group.keeps_orientation;
      if (face.keeps_orientation != group.keeps_orientation) continue;
      face.groups[c] = g;
      group.faces.push_back(f);
      for (const int next : {face.neighbors[(c + 2) % 3], face.neighbors[c]}) {
        if (next != kNone) waiting.push_back(next);
      }
    }
    std::sort(group.faces.begin(), group.faces.end());
  }

  // Of the faces of a group, those that do not point the opposite way.
  Vec3f tangent(const Group& group, int of_face) const {
    const Face& own = faces_[std::size_t(of_face)];
    const Vec3f normal = normals_[group.vertex], os = on_plane(own.os, normal), ot = on_plane(own.ot, normal);
    Vec3f sum;
    for (const int f : group.faces) {
      const Face& face = faces_[std::size_t(f)];
      if (face.any_group) continue;
      const Vec3f os2 = on_plane(face.os, normal), ot2 = on_plane(face.ot, normal);
      const bool joins = own.any_group || f == of_face || (dot(os, os2) > -1 && dot(ot, ot2) > -1);
      if (joins) sum += angle_at(face, group.vertex) * os2;
    }
    return unit_or_as_is(sum);
  }

  float angle_at(const Face& face, std::uint32_t vertex) const {
    const int c = corner_of(face, vertex);
    const Vec3f p = positions_[vertex], normal = normals_[vertex];
    const Vec3f before = on_plane(positions_[face.corners[std::size_t((c + 2) % 3)]] - p, normal);
    const Vec3f after = on_plane(positions_[face.corners[std::size_t((c + 1) % 3)]] - p, normal);
    return float(std::acos(double(std::clamp(dot(before, after), -1.0F, 1.0F))));
  }

  const std::vector<Vec3f>& positions_;
  const std::vector<Vec3f>& normals_;
  const std::vector<Vec2f>& uv_;
  std::vector<Face> faces_;
  std::vector<Group> groups_;
};

}  // namespace

std::vector<Vec4f> mikktspace_tangents(const std::vector<Vec3f>& positions, const std::vector<Vec3f>& normals,
                                       const std::vector<Vec2f>& uv, const std::vector<Triangle>& triangles) {
  std::vector<Vec4f> tangents = TangentSpaces(positions, normals, uv, triangles).corner_tangents();
  for (Vec4f& t : tangents) {
    const Vec3f direction{t.x, t.y, t.z};
    if (!is_finite(direction) || direction == Vec3f{}) t = {1, 0, 0, t.w};
  }
  return tangents;
}

}  // namespace chiaro::renderer

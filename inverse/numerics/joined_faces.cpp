#include "inverse/numerics/joined_faces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>

namespace chiaro::inverse::numerics {
namespace {

using Eigen::Vector3d;
using Points = std::vector<std::uint32_t>;

constexpr std::uint32_t kNone = ~0U;
constexpr int kMostRounds = 6;  // of ending edges at corners that lie on them

// Points in cubes of a grid, to find those near a place.
class PointGrid {
 public:
  PointGrid(std::vector<Vector3d>& points, double cell) : points_(points), cell_(cell) {}

  // The nearest point within `tolerance`, at most the cell's size; or a new one.
  std::uint32_t find_or_add(const Vector3d& place, double tolerance) {
    const std::array<std::int64_t, 3> cube = cube_of(place);
    std::uint32_t nearest = kNone;
    double least = tolerance;
    for (int n = 0; n < 27; ++n) {
      const auto found = cubes_.find(key({cube[0] + n % 3 - 1, cube[1] + n / 3 % 3 - 1, cube[2] + n / 9 - 1}));
      if (found == cubes_.end()) continue;
      for (const std::uint32_t point : found->second) {
        const double distance = (points_[point] - place).norm();
        if (distance < least || (distance == least && point < nearest)) nearest = point, least = distance;
      }
    }
    return nearest != kNone ? nearest : add(place, cube);
  }

 private:
  std::uint32_t add(const Vector3d& place, const std::array<std::int64_t, 3>& cube) {
    points_.push_back(place);
    cubes_[key(cube)].push_back(std::uint32_t(points_.size() - 1));
    return std::uint32_t(points_.size() - 1);
  }

  std::array<std::int64_t, 3> cube_of(const Vector3d& place) const {
    return {std::int64_t(std::floor(place.x() / cell_)), std::int64_t(std::floor(place.y() / cell_)),
            std::int64_t(std::floor(place.z() / cell_))};
  }

  // Cubes that fall together cost time and nothing else.
  static std::uint64_t key(const std::array<std::int64_t, 3>& cube) {
    return std::uint64_t(cube[0]) * 0x9E3779B97F4A7C15U ^ std::uint64_t(cube[1]) * 0xC2B2AE3D27D4EB4FU ^
           std::uint64_t(cube[2]) * 0x165667B19E3779F9U;
  }

  std::vector<Vector3d>& points_;
  double cell_;
  std::unordered_map<std::uint64_t, Points> cubes_;
};

class Joiner {
 public:
  Joiner(std::span<const std::array<std::uint32_t, 3>> triangles, const JoinTolerances& tolerances)
      : triangles_(triangles), tolerances_(tolerances), grid_(joined_.points, tolerances.contact) {}

  void weld(std::span<const Vector3d> positions) {
    for (const Vector3d& place : positions) {
      joined_.point_of.push_back(grid_.find_or_add(place, tolerances_.same_point));
    }
  }

  void make_faces() {
    pieces_.resize(triangles_.size());
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> known;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      std::array<std::uint32_t, 3> points{};
      for (int k = 0; k < 3; ++k) points[k] = joined_.point_of[triangles_[t][k]];
      std::rotate(points.begin(), std::min_element(points.begin(), points.end()), points.end());
      const bool flat = is_flat(points);
      const std::uint32_t same = flat ? kNone : known.try_emplace(points, t).first->second;
      joined_.same_triangle.push_back(same);
      if (same == t) pieces_[t].push_back({points.begin(), points.end()});
    }
  }

  void cut(std::span<const TriangleContact> contacts) {
    touched_.resize(triangles_.size());
    for (const TriangleContact& contact : contacts) {
      const std::uint32_t from = grid_.find_or_add(contact.segment.from, tolerances_.contact);
      const std::uint32_t to = grid_.find_or_add(contact.segment.to, tolerances_.contact);
      ends_.insert(ends_.end(), {from, to});
      for (const std::uint32_t triangle : {contact.a, contact.b}) cut(triangle, contact.segment);
    }
  }

  // Of faces with open edges or contacts.
  void merge_near_corners() {
    const std::vector<std::uint32_t> stays = merge(find_concerned().corners);
    for (std::uint32_t& point : joined_.point_of) point = stays[point];
    for (std::uint32_t& point : ends_) point = stays[point];
    for (std::size_t t = 0; t < pieces_.size(); ++t) {
      std::erase_if(pieces_[t], [&](Points& piece) {
        bool moved = touched_[t];
        for (std::uint32_t& point : piece) moved |= stays[point] != point, point = stays[point];
        return !is_face(piece) || (moved && is_thin(piece));
      });
    }
  }

  void end_edges_at_corners() {
    for (int round = 0; round < kMostRounds; ++round) {
      if (!end_edges_once()) return;
    }
  }

  JoinedFaces finish() {
    for (std::uint32_t t = 0; t < pieces_.size(); ++t) {
      for (Points& piece : pieces_[t]) joined_.faces.push_back({t, std::move(piece)});
    }
    return std::move(joined_);
  }

 private:
  const Vector3d& place(std::uint32_t point) const { return joined_.points[point]; }

  Vector3d area_vector(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return (place(b) - place(a)).cross(place(c) - place(a));
  }

  // Its least height is within the tolerance.
  bool is_flat(const std::array<std::uint32_t, 3>& p) const {
    double longest = 0;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, (place(p[(k + 1) % 3]) - place(p[k])).norm());
    return !(area_vector(p[0], p[1], p[2]).norm() > tolerances_.same_point * longest);
  }

  void cut(std::uint32_t triangle, const ContactSegment& segment) {
    triangle = joined_.same_triangle[triangle];
    if (triangle == kNone) return;
    touched_[triangle] = true;
    const std::array<std::uint32_t, 3>& t = triangles_[triangle];
    const Vector3d normal =
        area_vector(joined_.point_of[t[0]], joined_.point_of[t[1]], joined_.point_of[t[2]]).normalized();
    std::vector<Points> pieces;
    for (const Points& piece : pieces_[triangle]) cut(piece, normal, segment, pieces);
    pieces_[triangle] = std::move(pieces);
  }

  // Along the segment's line, where the segment goes through the piece.
  void cut(const Points& piece, const Vector3d& normal, const ContactSegment& segment, std::vector<Points>& out) {
    const Vector3d along = (segment.to - segment.from).normalized(), across = normal.cross(along);
    const double length = (segment.to - segment.from).norm();
    std::vector<double> height;
    for (const std::uint32_t point : piece) {
      const double h = across.dot(place(point) - segment.from);
      height.push_back(std::abs(h) <= tolerances_.contact ? 0 : h);
    }
    double first = length, last = 0;
    Points left, right;
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const std::size_t next = (k + 1) % piece.size();
      if (height[k] >= 0) left.push_back(piece[k]);
      if (height[k] <= 0) right.push_back(piece[k]);
      Vector3d crossing = place(piece[k]);
      if (height[k] * height[next] < 0) {
        crossing += height[k] / (height[k] - height[next]) * (place(piece[next]) - place(piece[k]));
        const std::uint32_t point = grid_.find_or_add(crossing, tolerances_.contact);
        for (Points* half : {&left, &right}) half->push_back(point);
      } else if (height[k] != 0) {
        continue;
      }
      first = std::min(first, along.dot(crossing - segment.from));
      last = std::max(last, along.dot(crossing - segment.from));
    }
    const bool through = std::min(last, length) - std::max(first, 0.0) > tolerances_.contact;
    if (!through || !is_face(left) || !is_face(right)) {
      out.push_back(piece);
    } else {
      out.insert(out.end(), {left, right});
    }
  }

  // Without corners that follow themselves, and without spikes.
  bool is_face(Points& points) const {
    for (std::size_t k = 0; k < points.size() && points.size() >= 3;) {
      const std::size_t next = (k + 1) % points.size(), after = (k + 2) % points.size();
      const bool spike = points[k] == points[after];
      if (spike || points[k] == points[next]) {
        points.erase(points.begin() + std::ptrdiff_t(next));
        k = 0;
      } else {
        ++k;
      }
    }
    if (points.size() < 3) return false;
    double area = 0;
    for (std::size_t k = 2; k < points.size(); ++k) area += area_vector(points[0], points[k - 1], points[k]).norm();
    return area > 0;
  }

  // It may have been turned over when corners moved; what is beside it is joined where it was.
  bool is_thin(const Points& points) const {
    Vector3d area = Vector3d::Zero();
    double longest = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      area += 0.5 * area_vector(points[0], points[k], points[(k + 1) % points.size()]);
      longest = std::max(longest, (place(points[(k + 1) % points.size()]) - place(points[k])).norm());
    }
    return area.norm() <= tolerances_.contact * longest;
  }

  using Edge = std::pair<std::uint32_t, std::uint32_t>;

  std::vector<Edge> sorted_edges() const {
    std::vector<Edge> edges;
    for (const auto& pieces : pieces_) {
      for (const Points& piece : pieces) {
        for (std::size_t k = 0; k < piece.size(); ++k)
          edges.push_back(std::minmax(piece[k], piece[(k + 1) % piece.size()]));
      }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
  }

  static bool is_open(const std::vector<Edge>& edges, const Edge& edge) {
    const auto range = std::equal_range(edges.begin(), edges.end(), edge);
    return range.second - range.first == 1;
  }

  // Faces with an open edge or a contact, and the corners of such faces.
  struct Concerned {
    std::vector<Points*> faces;
    Points corners;
  };

  Concerned find_concerned() {
    const std::vector<Edge> edges = sorted_edges();
    Concerned found{{}, ends_};
    for (std::uint32_t t = 0; t < pieces_.size(); ++t) {
      for (Points& piece : pieces_[t]) {
        bool concerned = touched_[t];
        for (std::size_t k = 0; k < piece.size() && !concerned; ++k) {
          concerned = is_open(edges, std::minmax(piece[k], piece[(k + 1) % piece.size()]));
        }
        if (!concerned) continue;
        found.faces.push_back(&piece);
        found.corners.insert(found.corners.end(), piece.begin(), piece.end());
      }
    }
    sort_by_height(found.corners);
    return found;
  }

  bool end_edges_once() {
    const Concerned concerned = find_concerned();
    bool changed = false;
    for (Points* face : concerned.faces) changed |= end_edges(*face, concerned.corners);
    return changed;
  }

  // Each corner goes to the first one within the tolerance that stays.
  std::vector<std::uint32_t> merge(const Points& corners) const {
    std::vector<std::uint32_t> stays(joined_.points.size());
    for (std::uint32_t p = 0; p < stays.size(); ++p) stays[p] = p;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector3d& here = place(corners[i]);
      for (std::size_t j = i; j-- > 0 && height(corners[j]) >= height(corners[i]) - tolerances_.contact;) {
        if (stays[corners[j]] != corners[j] || (place(corners[j]) - here).norm() > tolerances_.contact) continue;
        stays[corners[i]] = corners[j];
        break;
      }
    }
    return stays;
  }

  // Along a direction that no wall of a building is square to: few corners are as high as each other.
  double height(std::uint32_t point) const { return Vector3d(0.3, 0.5, 0.8).normalized().dot(place(point)); }

  void sort_by_height(Points& corners) const {
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(height(a), a) < std::pair(height(b), b);
    };
    std::sort(corners.begin(), corners.end(), before);
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  }

  bool end_edges(Points& face, const Points& corners) const {
    Points ended;
    for (std::size_t k = 0; k < face.size(); ++k) {
      ended.push_back(face[k]);
      append_corners_on(face[k], face[(k + 1) % face.size()], face, corners, ended);
    }
    const bool changed = ended.size() != face.size();
    face = std::move(ended);
    return changed;
  }

  void append_corners_on(std::uint32_t a, std::uint32_t b, const Points& face, const Points& corners,
                         Points& out) const {
    const double tolerance = tolerances_.contact, length = (place(b) - place(a)).norm();
    const auto [low, high] = std::minmax({height(a), height(b)});
    const Vector3d along = (place(b) - place(a)) / length;
    const Eigen::Array3d least = place(a).cwiseMin(place(b)).array() - tolerance;
    const Eigen::Array3d most = place(a).cwiseMax(place(b)).array() + tolerance;
    std::vector<std::pair<double, std::uint32_t>> found;
    auto corner = std::lower_bound(corners.begin(), corners.end(), low - tolerance,
                                   [&](std::uint32_t c, double least_height) { return height(c) < least_height; });
    for (; corner != corners.end() && height(*corner) <= high + tolerance; ++corner) {
      const Vector3d& p = place(*corner);
      if ((p.array() < least).any() || (p.array() > most).any()) continue;
      const double at = along.dot(p - place(a));
      if (at <= tolerance || at >= length - tolerance) continue;
      if ((place(a) + at * along - p).norm() > tolerance) continue;
      if (std::find(face.begin(), face.end(), *corner) == face.end()) found.push_back({at, *corner});
    }
    std::sort(found.begin(), found.end());
    for (const auto& [at, point] : found) out.push_back(point);
  }

  std::span<const std::array<std::uint32_t, 3>> triangles_;
  JoinTolerances tolerances_;
  JoinedFaces joined_;
  PointGrid grid_;
  std::vector<std::vector<Points>> pieces_;  // of each triangle
  std::vector<bool> touched_;                // by a contact
  Points ends_;                              // of contacts
};

}  // namespace

JoinedFaces join_faces(std::span<const Vector3d> positions, std::span<const std::array<std::uint32_t, 3>> triangles,
                       std::span<const TriangleContact> contacts, const JoinTolerances& tolerances) {
  Joiner joiner(triangles, tolerances);
  joiner.weld(positions);
  joiner.make_faces();
  joiner.cut(contacts);
  joiner.merge_near_corners();
  joiner.end_edges_at_corners();
  return joiner.finish();
}

}  // namespace chiaro::inverse::numerics

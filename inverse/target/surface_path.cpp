#include "inverse/target/surface_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <utility>

#include <Eigen/Geometry>

#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using renderer::Box3f;
using Piece = SurfacePath::Piece;

constexpr double kBehind = 0.01;    // a surface faces a point: not farther behind it than this × radius
constexpr double kWeld = 2e-3;      // of the radius: pieces of a section join
constexpr double kLongestWay = 3;   // of a section, × the straight line
constexpr double kStep = 1.0 / 8;   // × radius, of points in between where there is no section
constexpr double kStraight = 5e-5;  // pieces in one line: nodes in between are ≤ this × radius beside it
constexpr double kFarAway = std::numeric_limits<double>::infinity();

std::optional<SurfacePoint> snap(const ReceiverSurface& surface, const Vector3d& point, double radius, bool facing) {
  std::optional<SurfacePoint> nearest;
  double reach = radius;
  visit_near(surface.tree, to_vec3f(point), reach, [&](std::uint32_t item) {
    const SurfacePoint found = closest_on_surface(surface, item, point);
    const bool faces = found.normal.dot(point - found.position) >= -kBehind * radius;
    if (found.distance <= reach && (faces || !facing)) {
      if (!nearest || found.distance < nearest->distance) nearest = found;
      reach = nearest->distance;
    }
    return reach;
  });
  return nearest;
}

std::optional<SurfacePoint> snap(const ReceiverSurface& surface, const Vector3d& point, double radius) {
  const auto facing = snap(surface, point, radius, true);
  return facing ? facing : snap(surface, point, radius, false);
}

// The plane through two points of the surface: x from one to the other, y as the normals go.
struct SectionPlane {
  Vector3d origin, x, y, z;

  Vector2d flat(const Vector3d& p) const { return {x.dot(p - origin), y.dot(p - origin)}; }
  Vector3d lift(const Vector2d& p) const { return origin + p.x() * x + p.y() * y; }
};

std::optional<SectionPlane> section_plane(const SurfacePoint& a, const SurfacePoint& b) {
  const Vector3d x = (b.position - a.position).normalized();
  for (const Vector3d& normal : {Vector3d(a.normal + b.normal), a.normal, b.normal}) {
    const Vector3d z = x.cross(normal);
    if (z.norm() > 0.1) return SectionPlane{a.position, x, z.normalized().cross(x), z.normalized()};
  }
  return {};
}

struct FlatPiece {
  Vector2d from, to;
};

// Where the plane cuts a triangle; corners in the plane count as behind it, so that shared edges are cut alike.
void cut_triangle(const ReceiverSurface& surface, std::uint32_t item, const SectionPlane& plane,
                  std::vector<FlatPiece>& pieces) {
  std::array<Vector3d, 3> corners;
  std::array<double, 3> height{};
  const renderer::Triangle triangle = surface.triangle(item);
  for (int k = 0; k < 3; ++k) {
    corners[k] = to_eigen(surface.receivers.positions[triangle[k]]);
    height[k] = plane.z.dot(corners[k] - plane.origin);
  }
  std::vector<Vector2d> cuts;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if ((height[k] > 0) == (height[next] > 0)) continue;
    const double t = height[k] / (height[k] - height[next]);
    cuts.push_back(plane.flat(corners[k] + t * (corners[next] - corners[k])));
  }
  if (cuts.size() == 2) pieces.push_back({cuts[0], cuts[1]});
}

bool is_cut(const Box3f& box, const SectionPlane& plane, const Vector3d& middle, double reach) {
  const Vector3d center = to_eigen(box.center()), half = 0.5 * to_eigen(box.extent());
  if (std::abs(plane.z.dot(center - plane.origin)) > half.dot(plane.z.cwiseAbs())) return false;
  return ((center - middle).cwiseAbs() - half).maxCoeff() <= reach;
}

std::vector<FlatPiece> cut_surface(const ReceiverSurface& surface, const SectionPlane& plane, const Vector3d& middle,
                                   double reach) {
  std::vector<FlatPiece> pieces;
  std::vector<std::uint32_t> open{0};
  while (!open.empty()) {
    const BoxTree::Node& node = surface.tree.nodes[open.back()];
    open.pop_back();
    if (!is_cut(node.box, plane, middle, reach)) continue;
    for (std::uint32_t i = 0; i < node.count; ++i)
      cut_triangle(surface, surface.tree.items[node.first + i], plane, pieces);
    if (node.count == 0) open.insert(open.end(), {node.first, node.first + 1});
  }
  return pieces;
}

// The pieces of a section, ended wherever another ends on them, as a graph.
class SectionGraph {
 public:
  SectionGraph(const std::vector<FlatPiece>& pieces, const Vector2d& start, const Vector2d& end, double weld)
      : weld_(weld) {
    nodes_ = {start, end};
    for (const FlatPiece& piece : pieces) nodes_.insert(nodes_.end(), {piece.from, piece.to});
    weld_nodes(start, end);
    links_.resize(nodes_.size());
    for (const FlatPiece& piece : pieces) link(piece);
  }

  // From start to end, where there is a way of at most `longest`.
  std::vector<Vector2d> shortest_way(double longest) const {
    std::vector<double> distance(nodes_.size(), kFarAway);
    std::vector<std::size_t> before(nodes_.size(), start_);
    using Event = std::pair<double, std::size_t>;
    std::priority_queue<Event, std::vector<Event>, std::greater<>> events;
    events.push({distance[start_] = 0, start_});
    while (!events.empty() && events.top().second != end_) {
      const auto [at, node] = events.top();
      events.pop();
      if (at > distance[node]) continue;
      for (const std::size_t other : links_[node]) {
        const double way = at + (nodes_[other] - nodes_[node]).norm();
        if (!(way < distance[other]) || way > longest) continue;
        distance[other] = way, before[other] = node;
        events.push({way, other});
      }
    }
    std::vector<Vector2d> way;
    if (distance[end_] == kFarAway) return way;
    for (std::size_t node = end_; node != start_; node = before[node]) way.push_back(nodes_[node]);
    way.push_back(nodes_[start_]);
    std::reverse(way.begin(), way.end());
    return way;
  }

 private:
  static bool by_x(const Vector2d& a, const Vector2d& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); }

  void weld_nodes(const Vector2d& start, const Vector2d& end) {
    std::sort(nodes_.begin(), nodes_.end(), by_x);
    std::vector<Vector2d> kept;
    for (const Vector2d& node : nodes_) {
      bool known = false;
      for (std::size_t i = kept.size(); i-- > 0 && kept[i].x() >= node.x() - kSame * weld_ && !known;) {
        known = (kept[i] - node).norm() <= kSame * weld_;
      }
      if (!known) kept.push_back(node);
    }
    nodes_ = std::move(kept);
    start_ = nearest_node(start), end_ = nearest_node(end);
  }

  std::size_t nearest_node(const Vector2d& p) const {
    const auto nearer = [&](const Vector2d& a, const Vector2d& b) { return (a - p).norm() < (b - p).norm(); };
    return std::size_t(std::min_element(nodes_.begin(), nodes_.end(), nearer) - nodes_.begin());
  }

  void link(const FlatPiece& piece) {
    const Vector2d along = piece.to - piece.from;
    const double low = std::min(piece.from.x(), piece.to.x()) - weld_,
                 high = std::max(piece.from.x(), piece.to.x()) + weld_;
    std::vector<std::pair<double, std::size_t>> on;
    const auto first =
        std::lower_bound(nodes_.begin(), nodes_.end(), low, [](const Vector2d& n, double x) { return n.x() < x; });
    for (auto node = first; node != nodes_.end() && node->x() <= high; ++node) {
      const double t =
          along.squaredNorm() > 0 ? std::clamp((*node - piece.from).dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
      if ((piece.from + t * along - *node).norm() <= weld_) on.push_back({t, std::size_t(node - nodes_.begin())});
    }
    std::sort(on.begin(), on.end());
    for (std::size_t i = 1; i < on.size(); ++i) {
      links_[on[i - 1].second].push_back(on[i].second);
      links_[on[i].second].push_back(on[i - 1].second);
    }
  }

  static constexpr double kSame = 1e-3;  // × weld: one node
  double weld_;
  std::vector<Vector2d> nodes_;
  std::vector<std::vector<std::size_t>> links_;
  std::size_t start_ = 0, end_ = 0;
};

double distance_to_line(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  const Vector2d along = (b - a).normalized();
  return std::abs(along.x() * (p - a).y() - along.y() * (p - a).x());
}

// The farthest node that a straight piece from `from` leads to.
std::size_t end_of_straight(const std::vector<Vector2d>& way, std::size_t from, double radius) {
  std::size_t to = from + 1;
  for (; to + 1 < way.size() && (way[to + 1] - way[from]).norm() <= radius; ++to) {
    for (std::size_t i = from + 1; i <= to; ++i) {
      if (distance_to_line(way[from], way[to + 1], way[i]) > kStraight * radius) return to;
    }
  }
  return to;
}

void append_way(const SectionPlane& plane, const std::vector<Vector2d>& way, double radius, std::vector<Piece>& out) {
  for (std::size_t from = 0, to = 0; from + 1 < way.size(); from = to) {
    to = end_of_straight(way, from, radius);
    if (from > 0) out.push_back({plane.lift(way[from]), plane.lift(way[from])});
    out.push_back({plane.lift(way[from]), plane.lift(way[to])});
  }
}

bool append_section(const ReceiverSurface& surface, const SurfacePoint& a, const SurfacePoint& b, double radius,
                    std::vector<Piece>& out) {
  const double length = (b.position - a.position).norm();
  const auto plane = section_plane(a, b);
  if (!plane || surface.receivers.triangles.empty()) return false;
  const auto pieces = cut_surface(surface, *plane, 0.5 * (a.position + b.position), 0.5 * length + radius);
  const SectionGraph graph(pieces, plane->flat(a.position), plane->flat(b.position), kWeld * radius);
  const std::vector<Vector2d> way = graph.shortest_way(kLongestWay * length + radius);
  append_way(*plane, way, radius, out);
  return way.size() > 1;
}

void append_line(const ReceiverSurface& surface, const Vector3d& from, const Vector3d& to, double radius,
                 const renderer::Control& control, std::vector<Piece>& out) {
  const double steps = std::min(1e5, std::ceil((to - from).norm() / (kStep * radius)));
  for (double i = 1; i < steps; ++i) {
    control.stop_if_requested();
    if (const auto found = snap(surface, from + i / steps * (to - from), radius)) {
      out.push_back({found->position, found->position});
    }
  }
}

}  // namespace

SurfacePath lay_on_surface(const ReceiverSurface& surface, std::span<const Vec3f> points, float radius,
                           const renderer::Control& control) {
  SurfacePath path;
  std::optional<SurfacePoint> before;
  for (std::size_t i = 0; i < points.size(); ++i) {
    control.stop_if_requested();
    const std::optional<SurfacePoint> here = snap(surface, to_eigen(points[i]), radius);
    if (!here) path.far_points.push_back(i);
    const bool moved = before && here && (here->position - before->position).norm() > kWeld * radius;
    const bool joined = moved && append_section(surface, *before, *here, radius, path.pieces);
    if (i > 0 && !joined && (moved || !before || !here)) {
      append_line(surface, to_eigen(points[i - 1]), to_eigen(points[i]), radius, control, path.pieces);
    }
    if (here) path.pieces.push_back({here->position, here->position});
    before = here;
  }
  return path;
}

}  // namespace chiaro::inverse

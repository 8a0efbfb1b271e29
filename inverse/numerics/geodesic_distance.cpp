// Distance along a surface by windows of straight rays.
// Source: S.-Q. Xin, G.-J. Wang, Improving Chen and Han's Algorithm on the Discrete Geodesic Problem, ACM TOG 28(4),
// 2009: a window is the part of an edge that rays from one source reach through an unfolded strip of faces; windows are
// carried on in the order of their distance, and those that cannot be of use are dropped. Rays from a straight segment
// are parallel: those of a point very far away. Narrow windows end, and distances go on from vertex to vertex: that
// of a face's corner from the two others, by the image of the source that has their distances to them.
// Source: M. Novotni, R. Klein, Computing Geodesic Distances on Triangular Meshes, WSCG 2002.

#include "inverse/numerics/geodesic_distance.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

namespace chiaro::inverse::numerics {
namespace {

using Eigen::Vector2d;

constexpr double kNarrow = 1.0 / 500;          // windows end: width < this × reach
constexpr double kShortEdge = 1.0 / 12;        // vertices take over: edge ≤ this × reach
constexpr double kFarAway = 1e6;               // where the rays of a segment come from, × reach
constexpr double kSaddle = 0.02;               // rays bend at a vertex: its angles sum to > 2π + this
constexpr double kSame = 1e-9;                 // no improvement: distances differ by ≤ this × reach
constexpr double kSameImage = 1e-6;            // of two vertices: their distances to it agree within this × reach
constexpr double kOvertaken = 1e-3;            // windows end: later than this × reach, and more on long edges
constexpr std::size_t kMostWindows = 200'000;  // and kWindowsPerCorner: beyond, vertices alone go on
constexpr std::size_t kWindowsPerCorner = 10;
constexpr double kPi = 3.14159265358979323846;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Rays from an image of a source, in the plane of a face.
struct Wave {
  Vector2d image;
  double offset = 0;  // distance of the image itself
  std::uint32_t origin = 0;

  double distance(const Vector2d& p) const { return offset + (p - image).norm(); }
};

// The part of an edge through which a wave enters the face of `corner`, whose edge it is.
struct Window {
  std::uint32_t corner = 0;
  Vector2d from, to;  // seen by the wave: left and right
  Wave wave;
};

// What a vertex knows: how far the image is that its distance comes from.
struct Reached {
  double distance = std::numeric_limits<double>::infinity();
  double radius = 0;  // to the image, ≤ distance but for rays that come from far away
  std::uint32_t origin = 0;
  bool left = false;  // distances went on from here: of all that is nearer they are known
};

// The nearest first; of equal ones that which came first.
struct Event {
  double key = 0;
  std::size_t number = 0;
  bool is_vertex = false;
  std::size_t index = 0;

  bool operator<(const Event& other) const { return std::tie(other.key, other.number) < std::tie(key, number); }
};

class Propagation {
 public:
  Propagation(const FlatSurface& surface, double reach) : surface_(surface), reach_(reach) {
    reached_.resize(surface.vertex_count);
    index_corners();
  }

  void start(const GeodesicSource& source) {
    start_at(source.face, source.from, source.origin);
    if ((source.to - source.from).norm() <= kSame * reach_) return;
    start_at(source.face, source.to, source.origin);
    start_beside(source, source.from, source.to);
    start_beside(source, source.to, source.from);
  }

  void run() {
    while (!events_.empty()) {
      const Event event = events_.top();
      events_.pop();
      if (!event.is_vertex) {
        free_.push_back(event.index);
        enter(Window(windows_[event.index]));
      } else if (event.key == reached_[event.index].distance) {
        leave_vertex(std::uint32_t(event.index));
      }
    }
  }

  std::vector<GeodesicDistance> distances() const {
    std::vector<GeodesicDistance> result(reached_.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
      if (reached_[i].distance <= reach_) result[i] = {reached_[i].distance, reached_[i].origin};
    }
    return result;
  }

 private:
  const FlatSurface::Corner& corner(std::uint32_t c) const { return surface_.corners[c]; }
  const Vector2d& place(std::uint32_t c) const { return corner(c).place; }
  std::uint32_t begin(std::uint32_t face) const { return surface_.face_begin[face]; }
  std::uint32_t end(std::uint32_t face) const { return surface_.face_begin[face + 1]; }
  std::uint32_t next(std::uint32_t c) const { return c + 1 == end(face_[c]) ? begin(face_[c]) : c + 1; }
  std::uint32_t previous(std::uint32_t c) const { return c == begin(face_[c]) ? end(face_[c]) - 1 : c - 1; }

  void index_corners() {
    const std::size_t count = surface_.corners.size();
    face_.resize(count);
    fan_begin_.assign(surface_.vertex_count + 1, 0);
    for (std::uint32_t f = 0; f < surface_.face_count(); ++f)
      std::fill(&face_[begin(f)], &face_[begin(f)] + (end(f) - begin(f)), f);
    for (const FlatSurface::Corner& c : surface_.corners) ++fan_begin_[c.vertex + 1];
    for (std::size_t v = 0; v < surface_.vertex_count; ++v) fan_begin_[v + 1] += fan_begin_[v];
    fan_.resize(count);
    std::vector<std::uint32_t> filled(fan_begin_.begin(), fan_begin_.end() - 1);
    for (std::uint32_t c = 0; c < count; ++c) fan_[filled[corner(c).vertex]++] = c;
  }

  std::span<const std::uint32_t> fan(std::uint32_t vertex) const {
    return {fan_.data() + fan_begin_[vertex], fan_begin_[vertex + 1] - fan_begin_[vertex]};
  }

  // Of ways of one length the straight one has the image farther away: the others only pass a vertex that it meets.
  void reach_vertex(std::uint32_t vertex, const Reached& reached) {
    Reached& known = reached_[vertex];
    if (!known.left && std::abs(reached.distance - known.distance) <= kSame * reach_) {
      known.radius = std::max(known.radius, reached.radius);
    }
    if (!(reached.distance < known.distance - kSame * reach_) || reached.distance > reach_) return;
    const bool left = known.left;
    known = reached;
    known.left = left;
    events_.push({reached.distance, ++count_, true, vertex});
  }

  void push(const Window& window) {
    const double t = closest_parameter(window);
    const double key = window.wave.distance(window.from + t * (window.to - window.from));
    if (key > reach_ || is_useless(window) || made_ > kMostWindows + kWindowsPerCorner * face_.size()) return;
    std::size_t slot = windows_.size();
    if (free_.empty()) {
      windows_.push_back(window);
    } else {
      slot = free_.back();
      free_.pop_back();
      windows_[slot] = window;
    }
    ++made_;
    events_.push({key, ++count_, false, slot});
  }

  static double closest_parameter(const Window& window) {
    const Vector2d along = window.to - window.from;
    const double squared = along.squaredNorm();
    return squared > 0 ? std::clamp((window.wave.image - window.from).dot(along) / squared, 0.0, 1.0) : 0;
  }

  // Theorem 3.2: every ray through the window arrives later than by an end of its edge.
  bool is_useless(const Window& window) const {
    const std::uint32_t a = window.corner, b = next(a);
    const auto later = [&](std::uint32_t end, const Vector2d& gate) {
      return window.wave.distance(gate) >
             reached_[corner(end).vertex].distance + (gate - place(end)).norm() + kSame * reach_;
    };
    return later(a, window.to) || later(b, window.from) || is_overtaken(window);
  }

  // By what the ends of its edge say of the places in between: a distance bends by ≤ length² / 8 radius there. Waves
  // that meet do worse, but end there.
  bool is_overtaken(const Window& window) const {
    const std::uint32_t a = window.corner, b = next(a);
    const double at_a = reached_[corner(a).vertex].distance, at_b = reached_[corner(b).vertex].distance;
    if (!std::isfinite(at_a + at_b)) return false;
    const double length = (place(b) - place(a)).norm();
    const double margin = length * length / (4 * std::max(std::min(at_a, at_b), 0.5 * length)) + kOvertaken * reach_;
    const auto later = [&](const Vector2d& gate) {
      return window.wave.distance(gate) > std::lerp(at_a, at_b, (gate - place(a)).norm() / length) + margin;
    };
    return later(window.from) && later(window.to);
  }

  void enter(const Window& window) {
    if (!is_useless(window)) spread(window);
  }

  // The window's rays go on to the other corners and edges of its face.
  void spread(const Window& window) {
    const std::uint32_t face = face_[window.corner], after = next(window.corner);
    for (std::uint32_t c = begin(face); c < end(face); ++c) {
      if (c != window.corner && c != after) reach_corner(window, c);
      if (c != window.corner) leave_by_edge(window, c);
    }
  }

  void reach_corner(const Window& window, std::uint32_t c) {
    const Vector2d& image = window.wave.image;
    const Vector2d ray = place(c) - image;
    const Vector2d* bend = nullptr;
    if (cross(window.from - image, ray) > 0) bend = &window.from;
    if (cross(window.to - image, ray) < 0) bend = &window.to;
    const double radius = bend ? (place(c) - *bend).norm() : ray.norm();
    const double distance = bend ? window.wave.distance(*bend) + radius : window.wave.distance(place(c));
    reach_vertex(corner(c).vertex, {distance, radius, window.wave.origin});
  }

  void leave_by_edge(const Window& window, std::uint32_t c) {
    const Vector2d &a = place(c), &b = place(next(c)), &image = window.wave.image;
    const Vector2d left = window.from - image, right = window.to - image;
    // Counter-clockwise, the edge runs from right to left as the rays see it.
    const double right_a = cross(right, a - image), right_b = cross(right, b - image);
    const double left_a = cross(left, a - image), left_b = cross(left, b - image);
    double first = 0, last = 1;
    if (right_a < 0 && right_b <= 0) return;
    if (left_a >= 0 && left_b > 0) return;
    if (right_a < 0) first = right_a / (right_a - right_b);
    if (left_b > 0) last = left_a / (left_a - left_b);
    if (right_b < 0) last = std::min(last, right_a / (right_a - right_b));
    if (left_a > 0) first = std::max(first, left_a / (left_a - left_b));
    if (last > first) cross_edge(c, window.wave, a + first * (b - a), a + last * (b - a));
  }

  // Into the face beyond, which is unfolded around the edge.
  void cross_edge(std::uint32_t c, const Wave& wave, const Vector2d& right, const Vector2d& left) {
    const std::uint32_t beyond = corner(c).opposite;
    if (beyond == kNoCorner || (left - right).norm() < kNarrow * reach_) return;
    const Vector2d &a = place(c), &b = place(next(c)), &new_b = place(beyond), &new_a = place(next(beyond));
    const double length = (b - a).norm();
    const Vector2d x = (b - a) / length, new_x = (new_a - new_b).normalized() * -1.0;
    const auto moved = [&](const Vector2d& p) -> Vector2d {
      const double along = (p - a).dot(x), across = cross(x, p - a);
      return new_a + along * new_x + across * Vector2d(-new_x.y(), new_x.x());
    };
    push({beyond, moved(left), moved(right), {moved(wave.image), wave.offset, wave.origin}});
  }

  void start_at(std::uint32_t face, const Vector2d& point, std::uint32_t origin) {
    spread_from(face, {point, 0, origin}, kSame * reach_);
  }

  // All around: a face is convex. Edges that the point lies on are left out.
  void spread_from(std::uint32_t face, const Wave& wave, double margin) {
    for (std::uint32_t c = begin(face); c < end(face); ++c) {
      const Vector2d &a = place(c), &b = place(next(c));
      const double radius = (a - wave.image).norm();
      reach_vertex(corner(c).vertex, {wave.offset + radius, radius, wave.origin});
      if (cross(b - a, wave.image - a) > margin * (b - a).norm()) cross_edge(c, wave, a, b);
    }
  }

  // Parallel rays to the left of from → to.
  void start_beside(const GeodesicSource& source, const Vector2d& from, const Vector2d& to) {
    const Vector2d along = (to - from).normalized(), left(-along.y(), along.x());
    const double far = kFarAway * reach_;
    Window window;
    window.wave = {0.5 * (from + to) - far * left, -far, source.origin};
    // Seen from behind, `from` is on the left where the rays go to the left of from → to and that is up.
    window.from = from, window.to = to;
    for (std::uint32_t c = begin(source.face); c < end(source.face); ++c) {
      if (cross(to - from, place(c) - from) > 0) reach_if_beside(window, c);
      leave_by_edge_beside(window, c, left);
    }
  }

  void reach_if_beside(const Window& window, std::uint32_t c) {
    const Vector2d ray = place(c) - window.wave.image;
    const bool beside =
        cross(window.from - window.wave.image, ray) <= 0 && cross(window.to - window.wave.image, ray) >= 0;
    if (beside) reach_vertex(corner(c).vertex, {window.wave.distance(place(c)), ray.norm(), window.wave.origin});
  }

  // Edges that the rays go out by, and that the segment does not lie on.
  void leave_by_edge_beside(const Window& window, std::uint32_t c, const Vector2d& left) {
    const Vector2d along = (place(next(c)) - place(c)).normalized();
    const Vector2d middle = 0.5 * (window.from + window.to);
    if (cross(along, left) < -kSame && cross(along, middle - place(c)) > kSame * reach_) leave_by_edge(window, c);
  }

  bool bends_rays(std::uint32_t vertex) const {
    double angles = 0;
    for (const std::uint32_t c : fan(vertex)) {
      if (corner(c).opposite == kNoCorner || corner(previous(c)).opposite == kNoCorner) return true;
      const Vector2d out = place(next(c)) - place(c), in = place(previous(c)) - place(c);
      angles += std::atan2(cross(out, in), out.dot(in));
    }
    return angles > 2 * kPi + kSaddle;
  }

  void leave_vertex(std::uint32_t vertex) {
    const bool bends = bends_rays(vertex);
    reached_[vertex].left = true;
    for (const std::uint32_t c : fan(vertex)) {
      const Reached& reached = reached_[vertex];
      for (std::uint32_t other = begin(face_[c]); other < end(face_[c]); ++other) {
        const double radius = (place(other) - place(c)).norm();
        if (other != c) reach_vertex(corner(other).vertex, {reached.distance + radius, radius, reached.origin});
      }
      if (bends) bend_into(c, reached);
      carry_on(c, next(c));
      carry_on(previous(c), c);
    }
  }

  void bend_into(std::uint32_t c, const Reached& reached) {
    const Wave wave{place(c), reached.distance, reached.origin};
    for (std::uint32_t edge = next(c); edge != previous(c); edge = next(edge)) {
      cross_edge(edge, wave, place(edge), place(next(edge)));
    }
  }

  // Whether two vertices know their distances by one image.
  bool agree(const Reached& a, const Reached& b) const {
    return std::abs((a.distance - a.radius) - (b.distance - b.radius)) <= kSameImage * reach_;
  }

  // From both ends of a short edge to the other corners of its face, where the ray passes between them. Of two images
  // the one that has both distances may be nearer than any way is long: what that leads to is no nearer than the ends.
  void carry_on(std::uint32_t a, std::uint32_t b) {
    const Reached &from = reached_[corner(a).vertex], &to = reached_[corner(b).vertex];
    const Vector2d edge = place(b) - place(a);
    const double length = edge.norm();
    if (!(length <= kShortEdge * reach_) || length == 0 || !from.left || !to.left) return;
    const double radius = std::max(from.radius, to.radius + from.distance - to.distance);
    const double other = radius + to.distance - from.distance;
    const double along = (radius * radius - other * other + length * length) / (2 * length);
    const double squared = radius * radius - along * along;
    if (radius < 0 || other < 0 || squared < 0) return;
    const Vector2d x = edge / length, inward(-x.y(), x.x());
    const Vector2d image = place(a) + along * x - std::sqrt(squared) * inward;
    const std::uint32_t origin = from.distance <= to.distance ? from.origin : to.origin;
    for (std::uint32_t c = begin(face_[a]); c < end(face_[a]); ++c) {
      if (c == a || c == b) continue;
      const Vector2d ray = place(c) - image;
      const bool between = cross(place(a) - image, ray) <= 0 && cross(place(b) - image, ray) >= 0;
      const double distance = from.distance - radius + ray.norm();
      if (!between || (distance < std::max(from.distance, to.distance) && !agree(from, to))) continue;
      reach_vertex(corner(c).vertex, {distance, ray.norm(), origin});
    }
  }

  const FlatSurface& surface_;
  double reach_;
  std::vector<std::uint32_t> face_;             // of each corner
  std::vector<std::uint32_t> fan_begin_, fan_;  // the corners at each vertex
  std::vector<Reached> reached_;
  std::priority_queue<Event> events_;
  std::vector<Window> windows_;
  std::vector<std::size_t> free_;
  std::size_t count_ = 0, made_ = 0;
};

}  // namespace

std::vector<GeodesicDistance> geodesic_distance(const FlatSurface& surface, std::span<const GeodesicSource> sources,
                                                double reach) {
  Propagation propagation(surface, reach);
  for (const GeodesicSource& source : sources) propagation.start(source);
  propagation.run();
  return propagation.distances();
}

}  // namespace chiaro::inverse::numerics

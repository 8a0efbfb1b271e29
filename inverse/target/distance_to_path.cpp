#include "inverse/target/distance_to_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "inverse/numerics/closest_point.h"
#include "inverse/numerics/geodesic_distance.h"
#include "inverse/numerics/joined_faces.h"
#include "inverse/numerics/median.h"
#include "inverse/numerics/surface_contact.h"
#include "inverse/numerics/two_sided_surface.h"
#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using numerics::TriangleCorners;
using Piece = SurfacePath::Piece;

constexpr double kSamePoint = 1e-5;      // corners are one: distance ≤ this × scale
constexpr double kContact = 5e-3;        // surfaces meet: distance ≤ this × scale …
constexpr double kContactOfEdge = 0.05;  // … and ≤ this × the shortest edge, of their triangles and of most
constexpr double kOnFace = 1e-4;         // a piece of the path lies on a face: distance ≤ this × scale
constexpr double kCoarse = 0.02;         // edge > this × scale: of others, those that share a corner have no contact
constexpr double kRounding = 16.0 * std::numeric_limits<float>::epsilon();  // of coordinates
constexpr std::uint32_t kNone = ~0U;

// Calls visit(item) for triangles whose boxes may be within `reach` of the piece, some of them more than once.
template <class Visit>
void visit_near_piece(const ReceiverSurface& surface, const Piece& piece, double reach, const Visit& visit) {
  const double length = (piece.to - piece.from).norm();
  const double steps = std::max(1.0, std::ceil(length / std::max(reach, 1e-3 * length)));
  const double around = std::hypot(reach, length / (2 * steps));
  for (double i = 0; i < steps; ++i) {
    const Vector3d center = piece.from + (i + 0.5) / steps * (piece.to - piece.from);
    visit_near(surface.tree, to_vec3f(center), around + kRounding * center.cwiseAbs().maxCoeff(),
               [&](std::uint32_t item) {
                 visit(item, center, around);
                 return around;
               });
  }
}

// How much a list may grow, besides doubling, until what is twice in it goes.
constexpr std::size_t kSpare = 500'000;

void sort_unique(std::vector<std::uint32_t>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

std::vector<std::uint32_t> triangles_near(const ReceiverSurface& surface, const SurfacePath& path, double radius,
                                          const renderer::Control& control) {
  std::vector<std::uint32_t> near;
  std::size_t unique = 0;
  for (const Piece& piece : path.pieces) {
    control.stop_if_requested();
    visit_near_piece(surface, piece, radius, [&](std::uint32_t item, const Vector3d& center, double around) {
      if (closest_on_surface(surface, item, center).distance <= around) near.push_back(item);
    });
    if (near.size() > 2 * unique + kSpare) {
      sort_unique(near);
      unique = near.size();
    }
  }
  sort_unique(near);
  return near;
}

// The triangles near a path, with numbers of their own, turned so that counter-clockwise is their front.
struct Neighbourhood {
  std::vector<std::uint32_t> items, receivers;  // ascending
  std::vector<Vector3d> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  std::uint32_t number_of(std::uint32_t item) const {
    const auto found = std::lower_bound(items.begin(), items.end(), item);
    return found != items.end() && *found == item ? std::uint32_t(found - items.begin()) : kNone;
  }
  TriangleCorners corners(std::uint32_t t) const {
    return {positions[triangles[t][0]], positions[triangles[t][1]], positions[triangles[t][2]]};
  }
};

Neighbourhood make_neighbourhood(const ReceiverSurface& surface, std::vector<std::uint32_t> items) {
  Neighbourhood near{std::move(items), {}, {}, {}};
  for (const std::uint32_t item : near.items) {
    const renderer::Triangle t = surface.triangle(item);
    near.receivers.insert(near.receivers.end(), t.begin(), t.end());
  }
  sort_unique(near.receivers);
  for (const std::uint32_t r : near.receivers) near.positions.push_back(to_eigen(surface.receivers.positions[r]));
  for (const std::uint32_t item : near.items) {
    std::array<std::uint32_t, 3> local{};
    Vector3d normal = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t receiver = surface.triangle(item)[k];
      local[k] = std::uint32_t(std::lower_bound(near.receivers.begin(), near.receivers.end(), receiver) -
                               near.receivers.begin());
      normal += to_eigen(surface.receivers.normals[receiver]);
    }
    near.triangles.push_back(local);
    const TriangleCorners c = near.corners(std::uint32_t(near.triangles.size() - 1));
    if ((c[1] - c[0]).cross(c[2] - c[0]).dot(normal) < 0) std::swap(near.triangles.back()[1], near.triangles.back()[2]);
  }
  return near;
}

struct EdgeLengths {
  double shortest = 0, longest = 0;
};

EdgeLengths edge_lengths(const TriangleCorners& c) {
  const auto [least, most] = std::minmax({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()});
  return {least, most};
}

int shared_corners(const TriangleCorners& a, const TriangleCorners& b, double tolerance) {
  int same = 0;
  for (const Vector3d& p : a) {
    for (const Vector3d& q : b) same += (p - q).squaredNorm() <= tolerance * tolerance;
  }
  return same;
}

// Where triangles meet without sharing an edge. A larger brush finds what a smaller one does.
class ContactSearch {
 public:
  ContactSearch(const ReceiverSurface& surface, const Neighbourhood& near, const numerics::JoinTolerances& tolerances,
                double scale)
      : surface_(surface), near_(near), tolerances_(tolerances), coarse_(kCoarse * scale) {
    for (std::uint32_t t = 0; t < near.triangles.size(); ++t) edges_.push_back(edge_lengths(near.corners(t)));
  }

  std::vector<numerics::TriangleContact> run(const renderer::Control& control) const {
    constexpr std::size_t kTriangles = 256;
    const std::size_t count = near_.triangles.size(), parts = (count + kTriangles - 1) / kTriangles;
    std::vector<std::vector<numerics::TriangleContact>> found(parts);
    renderer::parallel_for(parts, "contacts", control.without_progress(), [&](std::size_t part) {
      for (std::size_t a = part * kTriangles; a < std::min(count, (part + 1) * kTriangles); ++a) {
        append_contacts_of(std::uint32_t(a), found[part]);
      }
    });
    std::vector<numerics::TriangleContact> contacts;
    for (const auto& some : found) contacts.insert(contacts.end(), some.begin(), some.end());
    return contacts;
  }

 private:
  // With those of higher numbers.
  void append_contacts_of(std::uint32_t a, std::vector<numerics::TriangleContact>& contacts) const {
    const TriangleCorners corners = near_.corners(a);
    const double reach = tolerance_of(edges_[a].shortest);
    const Eigen::Array3d least = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]).array() - reach;
    const Eigen::Array3d most = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]).array() + reach;
    std::vector<std::uint32_t> candidates;
    visit_overlapping(surface_.tree, {to_vec3f(least.matrix()), to_vec3f(most.matrix())}, [&](std::uint32_t item) {
      const std::uint32_t b = near_.number_of(item);
      if (b != kNone && b > a) candidates.push_back(b);
    });
    std::sort(candidates.begin(), candidates.end());
    for (const std::uint32_t b : candidates) {
      const TriangleCorners other = near_.corners(b);
      const bool coarse = edges_[a].longest > coarse_ || edges_[b].longest > coarse_;
      if (shared_corners(corners, other, tolerances_.same_point) >= (coarse ? 2 : 1)) continue;
      const double tolerance = tolerance_of(std::min(edges_[a].shortest, edges_[b].shortest));
      if (const auto segment = numerics::surface_contact(corners, other, tolerance))
        contacts.push_back({a, b, *segment});
    }
  }

  double tolerance_of(double edge) const {
    return std::max(tolerances_.same_point, std::min(tolerances_.contact, kContactOfEdge * edge));
  }

  const ReceiverSurface& surface_;
  const Neighbourhood& near_;
  const numerics::JoinTolerances& tolerances_;
  double coarse_;  // metres
  std::vector<EdgeLengths> edges_;
};

// The part of a segment that lies in a convex face, up to a tolerance.
std::optional<std::pair<Vector2d, Vector2d>> clip(const numerics::FlatSurface& surface, std::uint32_t face,
                                                  const Vector2d& from, const Vector2d& to, double tolerance) {
  double first = 0, last = 1;
  const std::uint32_t begin = surface.face_begin[face], end = surface.face_begin[face + 1];
  for (std::uint32_t c = begin; c < end; ++c) {
    const Vector2d& a = surface.corners[c].place;
    const Vector2d along = (surface.corners[c + 1 < end ? c + 1 : begin].place - a).normalized(),
                   inward(-along.y(), along.x());
    const double at_from = inward.dot(from - a) + tolerance, at_to = inward.dot(to - a) + tolerance;
    if (at_from < 0 && at_to < 0) return {};
    if (at_from < 0) first = std::max(first, at_from / (at_from - at_to));
    if (at_to < 0) last = std::min(last, at_from / (at_from - at_to));
  }
  if (last < first) return {};
  return std::pair<Vector2d, Vector2d>(from + first * (to - from), from + last * (to - from));
}

// The local surface, and where its parts come from.
struct LocalSurface {
  Neighbourhood near;
  numerics::JoinedFaces joined;
  numerics::TwoSidedSurface sides;
  std::vector<std::uint32_t> first_face;  // of each triangle, and the number of faces

  void append_sources(std::uint32_t item, const Piece& piece, std::uint32_t origin, double tolerance,
                      std::vector<numerics::GeodesicSource>& out) const {
    const std::uint32_t t = near.number_of(item);
    if (t == kNone) return;
    for (std::uint32_t f = first_face[t]; f < first_face[t + 1]; ++f) {
      const numerics::TwoSidedSurface::Frame& frame = sides.frames[f];
      const Vector2d from = frame.flat(piece.from), to = frame.flat(piece.to);
      const auto inside = clip(sides.surface, f, from, to, tolerance);
      if (!inside) continue;
      const double length = (to - from).norm();
      const auto height = [&](const Vector2d& p) {
        const double at = length > 0 ? (p - from).norm() / length : 0;
        return std::abs(frame.x.cross(frame.y).dot(piece.from + at * (piece.to - piece.from) - frame.origin));
      };
      if (std::max(height(inside->first), height(inside->second)) <= tolerance) {
        out.push_back({f, inside->first, inside->second, origin});
      }
    }
  }
};

// Metres: the radius, but no more than the surface is large. Tolerances are parts of it.
double scale_of(const ReceiverSurface& surface, double radius) {
  return surface.tree.nodes.empty() ? 0 : std::min(radius, double(surface.tree.nodes.front().box.diagonal()));
}

// No larger than the receivers' spacing allows, however large the brush.
double contact_tolerance(const Neighbourhood& near, double scale) {
  std::vector<double> shortest;
  for (std::uint32_t t = 0; t < near.triangles.size(); ++t) shortest.push_back(edge_lengths(near.corners(t)).shortest);
  if (shortest.empty()) return 0;
  return std::min(kContact * scale, kContactOfEdge * numerics::median(std::move(shortest)));
}

LocalSurface make_local_surface(const ReceiverSurface& surface, const SurfacePath& path, double radius, double scale,
                                const renderer::Control& control) {
  LocalSurface local{make_neighbourhood(surface, triangles_near(surface, path, radius, control)), {}, {}, {}};
  double largest = 0;
  for (const Vector3d& p : local.near.positions) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  const double same_point = std::max(kSamePoint * scale, kRounding * largest);
  const numerics::JoinTolerances tolerances{same_point, std::max(contact_tolerance(local.near, scale), same_point)};
  const auto contacts = ContactSearch(surface, local.near, tolerances, scale).run(control);
  local.joined = numerics::join_faces(local.near.positions, local.near.triangles, contacts, tolerances);
  local.sides = numerics::make_two_sided(local.joined);
  local.first_face.assign(local.near.triangles.size() + 1, 0);
  for (const auto& face : local.joined.faces) ++local.first_face[face.triangle + 1];
  for (std::size_t t = 0; t < local.near.triangles.size(); ++t) local.first_face[t + 1] += local.first_face[t];
  return local;
}

// Points before segments: of two as near, the first counts, and a point in a corner lies on both surfaces there.
std::vector<numerics::GeodesicSource> make_sources(const ReceiverSurface& surface, const LocalSurface& local,
                                                   const SurfacePath& path, double scale,
                                                   const renderer::Control& control) {
  std::vector<numerics::GeodesicSource> points, segments;
  std::vector<std::uint32_t> items;
  for (std::uint32_t i = 0; i < path.pieces.size(); ++i) {
    control.stop_if_requested();
    const double tolerance = kOnFace * scale;
    const Piece& piece = path.pieces[i];
    items.clear();
    visit_near_piece(surface, piece, tolerance,
                     [&](std::uint32_t item, const Vector3d&, double) { items.push_back(item); });
    sort_unique(items);
    for (const std::uint32_t item : items) {
      local.append_sources(item, piece, i, tolerance, piece.from == piece.to ? points : segments);
    }
  }
  points.insert(points.end(), segments.begin(), segments.end());
  return points;
}

// Of each receiver from the fronts of its triangles. Those of triangles without area from whatever front is there.
std::vector<numerics::GeodesicDistance> front_distances(const LocalSurface& local,
                                                        const std::vector<numerics::GeodesicDistance>& of_vertex) {
  const auto& [near, joined, sides, first_face] = local;
  std::vector<numerics::GeodesicDistance> of_receiver(near.receivers.size()), of_point(joined.points.size());
  const auto shorten = [](numerics::GeodesicDistance& known, const numerics::GeodesicDistance& found) {
    if (found.distance < known.distance) known = found;
  };
  std::vector<bool> has_front(near.receivers.size());
  for (std::uint32_t t = 0; t < near.triangles.size(); ++t) {
    const std::uint32_t same = joined.same_triangle[t];
    if (same == kNone) continue;
    for (std::uint32_t f = first_face[same]; f < first_face[same + 1]; ++f) {
      for (std::uint32_t k = 0; k < joined.faces[f].points.size(); ++k) {
        const std::uint32_t point = joined.faces[f].points[k];
        const auto& found = of_vertex[sides.surface.corners[sides.surface.face_begin[f] + k].vertex];
        shorten(of_point[point], found);
        for (const std::uint32_t receiver : near.triangles[t]) {
          if (joined.point_of[receiver] == point) shorten(of_receiver[receiver], found), has_front[receiver] = true;
        }
      }
    }
  }
  for (std::uint32_t i = 0; i < of_receiver.size(); ++i) {
    if (!has_front[i]) of_receiver[i] = of_point[joined.point_of[i]];
  }
  return of_receiver;
}

// Of each receiver that of the nearest piece; ascending.
void keep_nearest(std::vector<PathDistance>& distances) {
  std::sort(distances.begin(), distances.end(), [](const PathDistance& a, const PathDistance& b) {
    return std::tie(a.receiver, a.distance, a.piece) < std::tie(b.receiver, b.distance, b.piece);
  });
  const auto same = [](const PathDistance& a, const PathDistance& b) { return a.receiver == b.receiver; };
  distances.erase(std::unique(distances.begin(), distances.end(), same), distances.end());
}

}  // namespace

std::vector<PathDistance> distances_along_surface(const ReceiverSurface& surface, const SurfacePath& path,
                                                  double radius, const renderer::Control& control) {
  const double scale = scale_of(surface, radius);
  const LocalSurface local = make_local_surface(surface, path, radius, scale, control);
  const auto sources = make_sources(surface, local, path, scale, control);
  const auto found = front_distances(local, numerics::geodesic_distance(local.sides.surface, sources, radius));
  std::vector<PathDistance> distances;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i].distance <= radius) distances.push_back({local.near.receivers[i], found[i].distance, found[i].origin});
  }
  return distances;
}

std::vector<PathDistance> distances_through_space(const ReceiverSurface& surface, const SurfacePath& path,
                                                  double radius, const renderer::Control& control) {
  std::vector<PathDistance> all;
  std::size_t kept = 0;
  for (std::uint32_t i = 0; i < path.pieces.size(); ++i) {
    control.stop_if_requested();
    const Piece& piece = path.pieces[i];
    std::vector<std::uint32_t> receivers;
    visit_near_piece(surface, piece, radius, [&](std::uint32_t item, const Vector3d&, double) {
      const renderer::Triangle t = surface.triangle(item);
      receivers.insert(receivers.end(), t.begin(), t.end());
    });
    sort_unique(receivers);
    for (const std::uint32_t receiver : receivers) {
      const Vector3d place = to_eigen(surface.receivers.positions[receiver]);
      const double t = numerics::closest_on_segment(piece.from, piece.to, place);
      const double distance = (piece.from + t * (piece.to - piece.from) - place).norm();
      if (distance <= radius) all.push_back({receiver, distance, i});
    }
    if (all.size() < 2 * kept + kSpare) continue;
    keep_nearest(all);
    kept = all.size();
  }
  keep_nearest(all);
  return all;
}

}  // namespace chiaro::inverse

#include "inverse/solve/not_reached.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "inverse/solve/optimize_jointly.h"
#include "inverse/solve/stage_clock.h"
#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

constexpr double kSeen = 0.05;        // relative L2 beyond noise …
constexpr double kNoise = 1.5;        // … whose square is known as well as this
constexpr double kCell = 0.08;        // of the receivers' diagonal: what counts as one place
constexpr double kLeastCell = 0.005;  // of the squared error, that a cell counts with
constexpr double kLeastShare = 0.05;  // of the squared error
// A place of which one sees that it is not as painted, however little of all light is on it …
constexpr double kClear = 0.5;               // of what is wanted or found, whichever is more …
constexpr double kLit = 0.25;                // in mean brightness: it is not in the dark …
constexpr std::size_t kLeastReceivers = 12;  // … and no accident
constexpr std::size_t kMostPlaces = 3;
constexpr double kHue = 0.5;          // of the root mean square over channels, that less luminance is off
constexpr double kStillFalls = 0.95;  // of the error, or less, by the last light

// Part, the error's sign, and a cell of space.
using Cell = std::array<long, 5>;

struct Sums {
  double squared = 0, wanted = 0, found = 0;
  Vec3f excess;  // found − wanted
  std::size_t receivers = 0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
};

std::size_t part_of(const Receivers& receivers, std::size_t receiver) {
  const auto after =
      std::upper_bound(receivers.parts.begin(), receivers.parts.end(), receiver,
                       [](std::size_t i, const Receivers::Part& part) { return i < part.first_receiver; });
  return std::size_t(std::max<std::ptrdiff_t>(after - receivers.parts.begin() - 1, 0));
}

std::map<Cell, Sums> sums_by_cell(const Target& target, const std::vector<Vec3f>& illumination) {
  renderer::Box3f bounds;
  for (const Vec3f position : target.receivers.positions) bounds.extend(position);
  const double size = kCell * double(bounds.diagonal());
  std::map<Cell, Sums> cells;
  for (std::size_t i = 0; i < illumination.size(); ++i) {
    const Vec3f position = target.receivers.positions[i], error = illumination[i] - target.illumination[i];
    const double squared = double(target.weight[i]) * squared_norm(error);
    if (!(squared > 0)) continue;
    Cell cell{long(part_of(target.receivers, i)), luminance(error) > 0 ? 1 : 0};
    for (int a = 0; a < 3; ++a) cell[std::size_t(2 + a)] = std::lround(std::floor(double(position[a]) / size));
    Sums& sums = cells[cell];
    sums.squared += squared;
    ++sums.receivers;
    sums.wanted += double(luminance(target.illumination[i]));
    sums.found += double(luminance(illumination[i]));
    sums.excess += error;
    sums.moment += squared * to_eigen(position);
  }
  return cells;
}

double total_of(const std::map<Cell, Sums>& cells) {
  double total = 0;
  for (const auto& [cell, sums] : cells) total += sums.squared;
  return total;
}

void keep_clear_ones(const Target& target, std::map<Cell, Sums>& cells) {
  double brightness = 0, receivers = 0;
  for (std::size_t i = 0; i < target.illumination.size(); ++i) {
    if (!(target.weight[i] > 0)) continue;
    brightness += double(luminance(target.illumination[i]));
    ++receivers;
  }
  const double lit = kLit * brightness / std::max(1.0, receivers);
  std::erase_if(cells, [&](const auto& cell) {
    const Sums& sums = cell.second;
    const double more = std::max(sums.wanted, sums.found);
    return sums.receivers < kLeastReceivers || more < lit * double(sums.receivers) ||
           std::abs(sums.found - sums.wanted) < kClear * more;
  });
}

// Of each part of the receivers where it is too dark, and where it is too bright: all its cells that hold more than a
// little of the error, and the middle of the worst.
std::vector<NotReached> places_by_surface(const Receivers& receivers, const std::map<Cell, Sums>& cells, double total) {
  struct Surface {
    NotReached place;
    double worst = 0;  // squared error of a cell
    Vec3f excess;
  };
  std::map<std::array<long, 2>, Surface> surfaces;
  for (const auto& [cell, sums] : cells) {
    if (sums.squared < kLeastCell * total) continue;
    auto& [place, worst, excess] = surfaces[{cell[0], cell[1]}];
    const auto part = std::size_t(cell[0]);
    place.node = part < receivers.parts.size() ? receivers.parts[part].name : "";
    place.share += sums.squared / total;
    place.excess += sums.found - sums.wanted;
    place.wanted += sums.wanted;
    excess += sums.excess;
    place.other_color = std::abs(place.excess) < kHue * double(length(excess)) / std::sqrt(3);
    if (sums.squared > worst) worst = sums.squared, place.position = to_vec3f(sums.moment / sums.squared);
  }
  std::vector<NotReached> places;
  for (const auto& [key, surface] : surfaces) places.push_back(surface.place);
  return places;
}

// Or may, as far as anybody knows.
bool falls_still(const SolveResult& result, std::size_t count) {
  const auto& curve = result.error_curve;
  if (curve.size() < 2) return true;
  if (curve.back().lights.size() != count) return false;
  return curve.back().relative_l2 < kStillFalls * curve[curve.size() - 2].relative_l2;
}

// Of a box that it is in. Where a box has no extent, as one of lamps in a plane, nobody wanted them to go.
bool at_border_of(const renderer::Box3f& box, Vec3f position) {
  const Vec3f inside = min(position - box.min, box.max - position);
  const double near = kAtBorder * double(box.diagonal());
  for (int a = 0; a < 3; ++a) {
    if (box.extent()[a] > 0 && double(inside[a]) <= near) return true;
  }
  return false;
}

// Or it came so far that it might have gone farther.
bool at_border(const SolveProblem& problem, const SolveResult& result, const FoundLight& found) {
  const auto* light = std::get_if<renderer::PointLight>(&found.light);
  if (light == nullptr) return false;
  if (result.lights_may_be_farther && !default_region(problem.tracer).contains(light->position)) return true;
  std::vector<renderer::Box3f> boxes = problem.places.boxes;
  if (boxes.empty() && problem.places.mounts.empty()) boxes = {result.region};
  std::erase_if(boxes, [&](const renderer::Box3f& box) { return !box.contains(light->position); });
  return !boxes.empty() && std::all_of(boxes.begin(), boxes.end(),
                                       [&](const renderer::Box3f& box) { return at_border_of(box, light->position); });
}

bool any_at_border(const SolveProblem& problem, const SolveResult& result) {
  return std::any_of(result.lights.begin(), result.lights.end(),
                     [&](const FoundLight& found) { return at_border(problem, result, found); });
}

constexpr const char* kWithoutConstraints = "without the constraints lights may come closer";
constexpr const char* kLargerRegion = "lights stand at the border of their region: a larger one may help";

// As bright as they may be.
bool any_at_limit(const SolveProblem& problem, const SolveResult& result) {
  return std::any_of(result.lights.begin(), result.lights.end(), [&](const FoundLight& found) {
    const auto* light = std::get_if<renderer::PointLight>(&found.light);
    return light != nullptr && problem.intensities.limits(double(max_component(light->intensity)));
  });
}

}  // namespace

std::vector<NotReached> places_not_reached(const Target& target, const std::vector<Vec3f>& illumination, double noise) {
  std::map<Cell, Sums> cells = sums_by_cell(target, illumination);
  double wanted = 0;
  for (std::size_t i = 0; i < target.illumination.size(); ++i) {
    wanted += double(target.weight[i]) * squared_norm(target.illumination[i]);
  }
  const double total = total_of(cells);
  if (total <= (kSeen * kSeen + kNoise * noise * noise) * wanted) keep_clear_ones(target, cells);
  std::vector<NotReached> places = places_by_surface(target.receivers, cells, total);
  std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
  if (places.empty()) return places;
  places.resize(std::min(places.size(), kMostPlaces));
  std::erase_if(places, [&](const NotReached& p) { return p.share < kLeastShare && p.share < places.front().share; });
  return places;
}

std::string advice_for(const SolveProblem& problem, const SolveOptions& options, const SolveResult& result) {
  if (result.not_reached.empty()) return {};
  const bool ruled = problem.intensities.any();
  if (!problem.lights_in_place.empty()) {
    return ruled ? kWithoutConstraints : "lights that may move would come closer";
  }
  if (result.termination == Termination::kTimeLimit)
    return "more time may bring the lights closer: the time limit ended their search";
  const int most = most_lights(options);
  if (int(result.lights.size()) >= most && falls_still(result, result.lights.size())) {
    const bool held_back = (problem.grid.region || !problem.places.boxes.empty()) && any_at_border(problem, result);
    return fmt::format("more lights may come closer: {} {} allowed{}", most, most == 1 ? "was" : "were",
                       held_back ? std::string("; ") + kLargerRegion : "");
  }
  if (result.termination == Termination::kEarlierRefined) return "a solve without --from looks for further lights";
  if (options.method == SolveMethod::kThesis) return "the joint method, or another threshold, may come closer";
  if (any_at_limit(problem, result)) return kWithoutConstraints;
  if (any_at_border(problem, result)) return kLargerRegion;
  if (ruled || !problem.places.mounts.empty() || problem.places.surface_distance > 0 ||
      problem.places.light_distance > 0) {
    return kWithoutConstraints;
  }
  return problem.places.boxes.empty() && !problem.grid.region
             ? "no more lights explain it: paint it otherwise, give it less weight, or name a region farther away"
             : "no more lights from anywhere in the region explain it: paint it otherwise, or give it less weight";
}

void leave_unknown_beyond_region(SolveResult& result) {
  const float most = result.region.diagonal();
  for (FoundLight& found : result.lights) {
    for (int a = 0; a < 3; ++a) {
      if (found.position_interval[a] > most) found.position_interval[a] = renderer::kInfinity;
    }
  }
}

void leave_unknown_at_border(const SolveProblem& problem, SolveResult& result) {
  if (result.not_reached.empty()) return;
  const Vec3f unknown{renderer::kInfinity, renderer::kInfinity, renderer::kInfinity};
  for (FoundLight& found : result.lights) {
    if (at_border(problem, result, found)) found.position_interval = found.intensity_interval = unknown;
  }
}

}  // namespace chiaro::inverse

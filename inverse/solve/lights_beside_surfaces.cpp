#include "inverse/solve/lights_beside_surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "inverse/numerics/nelder_mead.h"
#include "inverse/solve/insertion.h"
#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

constexpr double kFew = 0.02;         // so small a part of the receivers holds nearly all that is left …
constexpr double kMustExplain = 0.5;  // … and one light must explain this much of it (squared norm) …
constexpr double kMayExplain = 0.25;  // … if it explains so much before its indirect light is traced
constexpr double kRest = 1e-4;        // of the energy, that the brightest receivers may miss
constexpr std::size_t kMostBrightest = kLightBlock;
constexpr float kFarthest = 0.02F;   // … from this part of the region's diagonal …
constexpr float kNearest = 0.0005F;  // … down to this one …
constexpr float kStep = 1.8F;        // … in these steps
constexpr std::size_t kStarts = 6;   // places that are refined
constexpr int kEvaluations = 90;     // of the simplex, from each
constexpr int kCalibrations = 2;     // rounds with the indirect light of path tracing
constexpr std::size_t kCalibrationPaths = 100000;
constexpr double kSimplex = 0.3;  // its edges, of the distance from the receiver

Eigen::VectorXd squared_residuals(const Observations& observations) {
  return (observations.sqrt_weight.asDiagonal() * observations.wanted).rowwise().squaredNorm();
}

// So few of the receivers that were drawn hold nearly all that is left, and so few of those that they stand for.
bool held_by_few(const Eigen::VectorXd& energy, const Eigen::VectorXd& stands_for) {
  return effective_part(energy, Eigen::VectorXd::Ones(energy.size())) <= kFew &&
         effective_part(energy, stands_for) <= kFew;
}

// The few that hold nearly all of the light.
std::vector<std::size_t> brightest_receivers(const Column& wanted) {
  const Eigen::VectorXd energy = wanted.cwiseMax(0.0).rowwise().squaredNorm();
  std::vector<std::size_t> order(std::size_t(energy.size()));
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return energy[Eigen::Index(a)] > energy[Eigen::Index(b)]; });
  double left = energy.sum();
  const double rest = kRest * left;
  std::size_t count = 0;
  while (count < std::min(kMostBrightest, order.size()) && left > rest) left -= energy[Eigen::Index(order[count++])];
  order.resize(count);
  return order;
}

// How badly one light at a place explains the brightest receivers, and how far from one of them it was first tried.
struct Place {
  LightEstimate light{Eigen::Vector3d::Zero(), Eigen::Array3d::Zero()};
  double misfit = std::numeric_limits<double>::infinity();
  double distance = 0;
};

bool anything_wanted(const Observations& observations) { return (observations.wanted.array() > 0).any(); }

// Looks for the one light that explains the brightest receivers (there must be some), all of them to the same fraction.
// To them it gives its exact indirect light; to all others its direct light, which must not be more than they have:
// that tells places inside a fixture from places outside.
class SingleLight {
 public:
  SingleLight(const LightResponse& response, const ExactIndirect& exact, const Observations& observations)
      : response_(response),
        exact_(exact),
        observations_(observations),
        brightest_(brightest_receivers(observations.wanted)),
        importance_(importance_of_gather_points(exact.gather(), brightest_)),
        calibration_(brightest_.size(), Vec3f{1, 1, 1}),
        relative_(observations) {
    const Eigen::VectorXd brightness = observations.wanted.rowwise().norm();
    const double darkest = brightness[Eigen::Index(brightest_.back())];
    bound_ = brightness.cwiseMax(darkest).cwiseInverse();
    relative_.sqrt_weight.setZero();
    for (const std::size_t i : brightest_) relative_.sqrt_weight[Eigen::Index(i)] = bound_[Eigen::Index(i)];
  }

  // Nothing where no light may stand near the brightest receivers, or where one farther away explains them better.
  std::optional<LightEstimate> find() {
    Place best;
    for (const Place& start : starts()) {
      const Place refined = refine(start);
      if (refined.misfit < best.misfit) best = refined;
    }
    if (!std::isfinite(best.misfit) || distance_from_brightest(best.light.position) > kFarthest * diagonal()) return {};
    return calibrated(best);
  }

  LightEstimate find_near(const Eigen::Vector3d& position) {
    const double distance = std::max(distance_from_brightest(position), double(kNearest) * diagonal());
    return calibrated({{position, Eigen::Array3d::Zero()}, 0, distance});
  }

 private:
  double diagonal() const { return double(response_.grid().region.diagonal()); }

  // Of the nearest of them.
  double distance_from_brightest(const Eigen::Vector3d& position) const {
    double distance = std::numeric_limits<double>::infinity();
    for (const std::size_t i : brightest_) {
      distance = std::min(distance, (position - to_eigen(response_.receivers()[i].position)).norm());
    }
    return distance;
  }

  LightEstimate calibrated(Place place) {
    for (int round = 0; round < kCalibrations; ++round) {
      calibrate(place.light.position);
      place.misfit = std::numeric_limits<double>::infinity();
      place = refine(place);
    }
    return place.light;
  }

  std::vector<Vec3f> gathered(const Eigen::Vector3d& position) const {
    return indirect_illumination_at(exact_.tracer(), exact_.gather(), importance_, brightest_.size(),
                                    to_vec3f(position));
  }

  // What path tracing finds at a place, in parts of what gathering finds there, goes for all places near it.
  void calibrate(const Eigen::Vector3d& position) {
    const std::vector<Vec3f> exact = exact_.traced(response_, brightest_, position, kCalibrationPaths),
                             found = gathered(position);
    for (std::size_t k = 0; k < brightest_.size(); ++k) {
      for (int c = 0; c < 3; ++c) calibration_[k][c] = found[k][c] > 0 ? exact[k][c] / found[k][c] : 1;
    }
  }

  Column column_at(const Eigen::Vector3d& position) const {
    Column column = response_.direct(position);
    const std::vector<Vec3f> indirect = gathered(position);
    for (std::size_t k = 0; k < brightest_.size(); ++k) {
      for (int c = 0; c < 3; ++c) {
        column(Eigen::Index(brightest_[k]), c) += double(calibration_[k][c] * indirect[k][c]);
      }
    }
    return column;
  }

  // Misfit infinite where no light may stand.
  Place judge(const Eigen::Vector3d& wanted, double distance) const {
    const auto position = response_.places().nearest(wanted);
    if (!position) return {};
    Place place{{*position, Eigen::Array3d::Ones()}, 0, distance};
    const Column column = column_at(*position);
    fit_intensity(relative_, column, place.light);
    const Column left = observations_.wanted - column * place.light.intensity.matrix().asDiagonal();
    place.misfit = (relative_.sqrt_weight.asDiagonal() * left).squaredNorm() +
                   (bound_.asDiagonal() * left.cwiseMin(0.0)).squaredNorm();
    return place;
  }

  std::vector<Place> starts() const {
    std::vector<Place> places;
    for (float t = kFarthest; t > kNearest; t /= kStep) {
      const float distance = t * response_.grid().region.diagonal();
      for (const Eigen::Vector3d& position : places_in_front(response_, brightest_, distance)) {
        places.push_back(judge(position, double(distance)));
      }
    }
    std::erase_if(places, [](const Place& place) { return !std::isfinite(place.misfit); });
    std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.misfit < b.misfit; });
    places.resize(std::min(kStarts, places.size()));
    return places;
  }

  // Over the position alone; the intensity that fits best belongs to it. Shadows of a fixture's parts come and go, so
  // there is no derivative to follow.
  Place refine(const Place& start) const {
    Place best = start;
    const auto misfit = [&](const Eigen::VectorXd& x) {
      const Place place = judge(x, start.distance);
      if (place.misfit < best.misfit) best = place;
      return place.misfit;
    };
    const Box3f region = response_.grid().region;
    numerics::NelderMeadOptions options;
    options.max_evaluations = kEvaluations;
    numerics::nelder_mead(misfit, start.light.position, Eigen::VectorXd::Constant(3, kSimplex * start.distance),
                          to_eigen(region.min), to_eigen(region.max), options);
    return best;
  }

  const LightResponse& response_;
  const ExactIndirect& exact_;
  const Observations& observations_;
  std::vector<std::size_t> brightest_;
  std::vector<LightBlock> importance_;
  std::vector<Vec3f> calibration_;  // of the brightest receivers' indirect light
  Observations relative_;           // of the brightest receivers alone
  Eigen::VectorXd bound_;           // weight of what a receiver gets too much
};

}  // namespace

LightEstimates find_lights_beside_surfaces(const LightResponse& response, const ExactIndirect& exact,
                                           const Observations& observations, int most) {
  Observations left = observations;
  LightEstimates found;
  while (int(found.size()) < most && anything_wanted(left)) {
    const Eigen::VectorXd energy = squared_residuals(left);
    if (!held_by_few(energy, left.stands_for)) break;
    const std::optional<LightEstimate> light = SingleLight(response, exact, left).find();
    if (!light) break;
    LightEstimates one{*light};
    if (squared_residuals(less(left, response, one)).sum() > (1 - kMayExplain) * energy.sum()) break;
    exact.correct_by_paths(response, left, one);
    left = less(std::move(left), response, one);
    if (squared_residuals(left).sum() > (1 - kMustExplain) * energy.sum()) break;
    found.push_back(one.front());
  }
  return found;
}

LightEstimates refine_lights_beside_surfaces(const LightResponse& response, const ExactIndirect& exact,
                                             const Observations& observations, const LightEstimates& lights,
                                             const LightEstimates& others) {
  const Observations left = less(observations, response, others);
  LightEstimates refined = lights;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    LightEstimates rest = refined;
    rest.erase(rest.begin() + std::ptrdiff_t(j));
    const Observations alone = less(left, response, rest);
    if (!anything_wanted(alone)) continue;
    LightEstimates one{SingleLight(response, exact, alone).find_near(lights[j].position)};
    exact.correct_by_paths(response, alone, one);
    refined[j] = one.front();
  }
  return refined;
}

}  // namespace chiaro::inverse

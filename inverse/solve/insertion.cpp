#include "inverse/solve/insertion.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "inverse/numerics/chosen_from.h"
#include "inverse/numerics/indices_of_greatest.h"
#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

constexpr std::size_t kMostInsertions = 3;
constexpr std::size_t kDarkest = 16;      // receivers in front of which a light is tried …
constexpr std::size_t kTraced = 12;       // … of each distance, those that explain most if nothing is in the way, …
constexpr std::size_t kTracedOfAll = 48;  // the same of all places there are
constexpr float kFarthest = 0.05F;        // … from this part of the region's diagonal …
constexpr float kNearest = 0.0005F;       // … down to this one …
constexpr float kStep = 2.0F;             // … in these steps
constexpr double kHidden = 1e-4;          // of the mean brightness, or less: hardly any light gets there
// Along the normal, and around it at 30 and at 60 degrees.
constexpr Vec3f kDirections[] = {{0, 0, 1},           {.5F, 0, .87F},    {-.25F, .43F, .87F}, {-.25F, -.43F, .87F},
                                 {.87F, 0, .5F},      {.43F, .75F, .5F}, {-.43F, .75F, .5F},  {-.87F, 0, .5F},
                                 {-.43F, -.75F, .5F}, {.43F, -.75F, .5F}};

struct Insertion {
  double gain = 0;
  LightEstimate light;
};

// What one light explains, by the intensity that fits best.
class IntensityGain {
 public:
  explicit IntensityGain(const Observations& observations)
      : IntensityGain(observations.sqrt_weight.cwiseAbs2(), observations.wanted) {}

  // By the receivers that any light gets to. Absent: it gets to all.
  static std::optional<IntensityGain> by_lit(const Observations& observations) {
    const Eigen::ArrayXd brightness = observations.target.rowwise().norm();
    const auto lit = brightness > kHidden * brightness.mean();
    if (lit.all()) return std::nullopt;
    return IntensityGain(lit.select(observations.sqrt_weight.array().square(), 0).matrix(), observations.wanted);
  }

  double fit(const Column& column, LightEstimate& light) const {
    Eigen::Array3d along, squared;
    for (int c = 0; c < 3; ++c) {
      along[c] = std::max(0.0, pull_.col(c).dot(column.col(c)));
      squared[c] = std::max(1e-300, (weight_.array() * column.col(c).array().square()).sum());
    }
    light.intensity = along / squared;
    return (along.square() / squared).sum();
  }
  // Of the same light in all channels.
  double of_grey(const Eigen::VectorXd& column) const {
    const Eigen::Array3d along = (pull_.transpose() * column).array().max(0);
    return along.square().sum() / std::max(1e-300, (weight_.array() * column.array().square()).sum());
  }

 private:
  IntensityGain(Eigen::VectorXd weight, const Column& wanted)
      : weight_(std::move(weight)), pull_(weight_.asDiagonal() * wanted) {}

  Eigen::VectorXd weight_;
  Column pull_;
};

// Of these places the one that explains most by its column, and nothing where none explains anything.
template <class ColumnAt>
std::optional<Insertion> best_insertion(const IntensityGain& explains, const std::vector<Eigen::Vector3d>& places,
                                        const ColumnAt& column_at) {
  std::vector<Insertion> tried(places.size());
  renderer::parallel_for(places.size(), [&](std::size_t j) {
    tried[j].light = {places[j], Eigen::Array3d::Ones()};
    tried[j].gain = explains.fit(column_at(j), tried[j].light);
  });
  const auto best =
      std::max_element(tried.begin(), tried.end(), [](const auto& a, const auto& b) { return a.gain < b.gain; });
  if (best == tried.end() || !(best->gain > 0)) return std::nullopt;
  return *best;
}

std::vector<std::size_t> darkest_receivers(const Observations& residual) {
  std::vector<double> lack;
  for (Eigen::Index i = 0; i < residual.wanted.rows(); ++i) {
    const double painted = residual.sqrt_weight[i] > 0 ? 1 : 0;
    lack.push_back(painted * residual.wanted.row(i).sum());
  }
  return numerics::indices_of_greatest(lack, kDarkest);
}

// Of many places those where a light explains most if nothing is in the way.
class MostPromising {
 public:
  // explains: by all receivers.
  MostPromising(const LightResponse& response, const Observations& residual, const IntensityGain& explains)
      : response_(response), by_all_(explains), by_lit_(IntensityGain::by_lit(residual)) {}

  // So many at most. A receiver that no light gets to would be bright if nothing were in the way, and tell against all
  // places near it: half of the places are chosen without those.
  std::vector<Eigen::Vector3d> of(const std::vector<Eigen::Vector3d>& places, std::size_t most) const {
    std::vector<double> gain_by_all(places.size()), gain_by_lit(by_lit_ ? places.size() : 0);
    renderer::parallel_for(places.size(), [&](std::size_t j) {
      const Eigen::VectorXd column = response_.unoccluded(places[j]);
      gain_by_all[j] = by_all_.of_grey(column);
      if (by_lit_) gain_by_lit[j] = by_lit_->of_grey(column);
    });
    std::vector<std::size_t> chosen = numerics::indices_of_greatest(gain_by_lit, most / 2);
    for (const std::size_t j : numerics::indices_of_greatest(gain_by_all, most)) {
      const bool is_new = std::find(chosen.begin(), chosen.end(), j) == chosen.end();
      if (is_new && chosen.size() < most) chosen.push_back(j);
    }
    return numerics::chosen_from(places, chosen);
  }

 private:
  const LightResponse& response_;
  const IntensityGain& by_all_;
  std::optional<IntensityGain> by_lit_;  // absent: light gets to all
};

std::optional<Insertion> best_by_direct_light(const LightResponse& response, const IntensityGain& explains,
                                              const std::vector<Eigen::Vector3d>& places) {
  return best_insertion(explains, places, [&](std::size_t j) { return response.direct(places[j]); });
}

}  // namespace

std::optional<LightEstimate> propose_directly_lit(const LightResponse& response, const Observations& residual,
                                                  const std::vector<Eigen::Vector3d>& places, double least_gain) {
  const IntensityGain explains(residual);
  const MostPromising promising(response, residual, explains);
  const auto best = best_by_direct_light(response, explains, promising.of(places, kTracedOfAll));
  if (!best || best->gain <= least_gain) return std::nullopt;
  return best->light;
}

double fit_intensity(const Observations& observations, const Column& column, LightEstimate& light) {
  return IntensityGain(observations).fit(column, light);
}

std::vector<Eigen::Vector3d> places_in_front(const LightResponse& response, const std::vector<std::size_t>& receivers,
                                             float distance) {
  std::vector<Eigen::Vector3d> places;
  for (const std::size_t i : receivers) {
    const renderer::SurfaceSample& at = response.receivers()[i];
    const renderer::Frame3f frame(at.normal);
    for (const Vec3f& direction : kDirections) {
      const Vec3f p = at.position + distance * frame.world_from_local(direction);
      if (response.grid().region.contains(p)) places.push_back(to_eigen(p));
    }
  }
  return places;
}

LightEstimates propose_insertions(const LightResponse& response, const Observations& observations,
                                  const LightEstimates& lights) {
  const Observations residual = less(observations, response, lights);
  const IntensityGain explains(residual);
  const MostPromising promising(response, residual, explains);
  const std::vector<std::size_t> darkest = darkest_receivers(residual);
  std::vector<Insertion> insertions;
  for (float t = kFarthest; t > kNearest; t /= kStep) {
    const auto places = places_in_front(response, darkest, t * response.grid().region.diagonal());
    // The grid's indirect light says nothing about a place inside a fixture.
    auto best = best_by_direct_light(response, explains, promising.of(places, kTraced));
    if (!best) continue;
    best->light.correction = -response.interpolated_indirect(best->light.position);
    insertions.push_back(std::move(*best));
  }
  const std::vector<std::size_t>& grid = response.grid_lights_near_places();
  std::vector<Eigen::Vector3d> places;
  for (const std::size_t light : grid) places.push_back(to_eigen(response.grid().positions[light]));
  auto best = best_insertion(explains, places, [&](std::size_t j) { return response.grid_column(grid[j]); });
  if (best) insertions.push_back(std::move(*best));
  std::stable_sort(insertions.begin(), insertions.end(), [](const auto& a, const auto& b) { return a.gain > b.gain; });
  LightEstimates proposals;
  for (std::size_t k = 0; k < std::min(insertions.size(), kMostInsertions); ++k)
    proposals.push_back(insertions[k].light);
  return proposals;
}

}  // namespace chiaro::inverse

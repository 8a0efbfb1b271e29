#include "inverse/solve/pair_of_lights.h"

#include <algorithm>
#include <array>
#include <limits>

#include "inverse/numerics/chosen_from.h"
#include "inverse/numerics/indices_of_greatest.h"
#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

constexpr std::size_t kNearest = 64;  // lights of the grid, of which any two are tried
constexpr double kFarthest = 0.25;    // of the region's diagonal, that they may be away

std::vector<std::size_t> grid_lights_near(const LightResponse& response, const Eigen::Vector3d& position) {
  const double farthest = kFarthest * double(response.grid().region.diagonal());
  std::vector<double> nearness;
  std::vector<std::size_t> lights;
  for (const std::size_t j : response.grid_lights_near_places()) {
    const double distance = (to_eigen(response.grid().positions[j]) - position).norm();
    if (distance > farthest) continue;
    nearness.push_back(-distance);
    lights.push_back(j);
  }
  return numerics::chosen_from(lights, numerics::indices_of_greatest(nearness, kNearest));
}

// Normal equations of the candidates in one channel.
struct Normal {
  Eigen::MatrixXd gram;
  Eigen::VectorXd pull;

  double gain_of_one(Eigen::Index a) const {
    const double pulled = std::max(0.0, pull[a]);
    return pulled * pulled / std::max(gram(a, a), 1e-300);
  }
  // By the intensities ≥ 0 that fit best: both, or one alone.
  double gain(Eigen::Index a, Eigen::Index b) const {
    const double determinant = gram(a, a) * gram(b, b) - gram(a, b) * gram(a, b);
    const double of_a = gram(b, b) * pull[a] - gram(a, b) * pull[b];
    const double of_b = gram(a, a) * pull[b] - gram(a, b) * pull[a];
    if (of_a > 0 && of_b > 0 && determinant > 0) return (of_a * pull[a] + of_b * pull[b]) / determinant;
    return std::max(gain_of_one(a), gain_of_one(b));
  }
};

std::array<Normal, 3> normal_equations(const std::array<WeightedSystem, 3>& channels) {
  std::array<Normal, 3> normal;
  for (int c = 0; c < 3; ++c) {
    normal[c] = {channels[c].a.transpose() * channels[c].a, channels[c].a.transpose() * channels[c].b};
  }
  return normal;
}

std::pair<Eigen::Index, Eigen::Index> best_pair(const std::array<Normal, 3>& channels) {
  std::pair<Eigen::Index, Eigen::Index> best{0, 0};
  double most = -1;
  for (Eigen::Index a = 0; a < channels[0].pull.size(); ++a) {
    for (Eigen::Index b = a + 1; b < channels[0].pull.size(); ++b) {
      const double gain = channels[0].gain(a, b) + channels[1].gain(a, b) + channels[2].gain(a, b);
      if (gain > most) most = gain, best = {a, b};
    }
  }
  return best;
}

struct Proposal {
  LightEstimates lights;
  double error = std::numeric_limits<double>::infinity();
};

// Without an error: the grid has no two lights near.
Proposal with_pair(const LightResponse& response, const Observations& observations, LightEstimates lights,
                   std::vector<Column> columns, std::size_t replaced) {
  const std::vector<std::size_t> candidates = grid_lights_near(response, lights[replaced].position);
  if (candidates.size() < 2) return {};
  std::vector<Column> grid;
  for (const std::size_t j : candidates) grid.push_back(response.grid_column(j));
  Observations alone = observations;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    if (j != replaced) alone.wanted -= columns[j] * lights[j].intensity.matrix().asDiagonal();
  }
  const auto [a, b] = best_pair(normal_equations(weighted_systems(alone, grid)));
  const auto at = [&](Eigen::Index k) {
    return LightEstimate{to_eigen(response.grid().positions[candidates[std::size_t(k)]]), Eigen::Array3d::Ones()};
  };
  lights[replaced] = at(a);
  lights.push_back(at(b));
  columns[replaced] = grid[std::size_t(a)];
  columns.push_back(grid[std::size_t(b)]);
  const double error = refit_intensities(observations, columns, lights);
  return {std::move(lights), error};
}

}  // namespace

std::vector<LightEstimates> propose_pairs(const LightResponse& response, const Observations& observations,
                                          const LightEstimates& lights, std::size_t most) {
  const std::vector<Column> columns = evaluate_columns(response, lights, Evaluation::kTracedVisibility);
  std::vector<Proposal> proposals(lights.size());
  renderer::parallel_for(lights.size(),
                         [&](std::size_t j) { proposals[j] = with_pair(response, observations, lights, columns, j); });
  std::erase_if(proposals, [](const Proposal& p) { return p.lights.empty(); });
  return best_sets(std::move(proposals), most);
}

}  // namespace chiaro::inverse

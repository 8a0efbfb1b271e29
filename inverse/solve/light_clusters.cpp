// Chen, Lighting Design with Illumination Brush, 2008, sections 3.3.2, 3.4.1 and 3.4.2.

#include "inverse/solve/light_clusters.h"

#include <map>

#include "inverse/numerics/lightcut.h"
#include "inverse/numerics/watershed.h"

namespace chiaro::inverse {
namespace {

// Sums that (3.7) and (3.8) need.
struct Merged {
  Eigen::Vector3d weighted_position = Eigen::Vector3d::Zero();
  double weight = 0;
  Eigen::Vector3d sum_of_positions = Eigen::Vector3d::Zero();
  int count = 0;
  Eigen::Array3d intensity = Eigen::Array3d::Zero();

  void add(const LightEstimate& light, double contribution) {
    weighted_position += contribution * light.position;
    weight += contribution;
    sum_of_positions += light.position;
    ++count;
    intensity += light.intensity;
  }
  // Lights that contribute nothing, as where they were merged inside a solid, count alike.
  LightEstimate light() const {
    return {weight > 0 ? Eigen::Vector3d(weighted_position / weight) : Eigen::Vector3d(sum_of_positions / count),
            intensity};
  }
};

// D of (3.6) between two unity lights, made symmetric by the mean of both norms.
double unity_distance(const Observations& observations, const Column& a, const Column& b) {
  const auto norm = [&](const Column& c) { return (observations.sqrt_weight.asDiagonal() * c).norm(); };
  const double scale = 0.5 * (norm(a) + norm(b));
  return scale > 0 ? norm(a - b) / scale : 0;
}

}  // namespace

LightEstimates segment_distribution(const LightDistribution& distribution, const Observations& observations) {
  const LightEstimates& lights = distribution.rounds[1].lights;
  numerics::ScalarField field;
  field.counts = distribution.lattice_counts;
  field.values.assign(std::size_t(field.counts[0]) * field.counts[1] * field.counts[2], 0);
  for (std::size_t j = 0; j < lights.size(); ++j) field.values[distribution.nodes[j]] = lights[j].intensity.sum();
  const std::vector<int> basin = numerics::watershed(field);
  std::map<int, Merged> clusters;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    const double contribution = contribution_norm(observations, distribution.columns[j], lights[j].intensity);
    clusters[basin[distribution.nodes[j]]].add(lights[j], contribution);
  }
  LightEstimates result;
  for (const auto& [number, merged] : clusters) result.push_back(merged.light());
  return result;
}

LightTree make_light_tree(const LightResponse& response, const Observations& observations,
                          const LightEstimates& clusters) {
  LightTree result;
  result.representatives = clusters;
  result.columns = evaluate_columns(response, clusters, Evaluation::kTracedVisibility);
  const auto distance = [&](int a, int b) {
    return unity_distance(observations, result.columns[a], result.columns[b]);
  };
  const auto merge = [&](int left, int right, int) {
    Merged merged;
    for (const int child : {left, right}) {
      const LightEstimate& light = result.representatives[child];
      merged.add(light, contribution_norm(observations, result.columns[child], light.intensity));
    }
    result.representatives.push_back(merged.light());
    result.columns.push_back(response.evaluate(merged.light().position, Evaluation::kTracedVisibility));
  };
  result.tree = numerics::build_light_tree(int(clusters.size()), distance, merge);
  return result;
}

LightCutResult cut_light_tree(const LightTree& tree, const Observations& observations, const CutOptions& options) {
  const auto error = [&](const std::vector<int>& cut) {
    Column sum = Column::Zero(observations.wanted.rows(), 3);
    for (const int node : cut) sum += tree.columns[node] * tree.representatives[node].intensity.matrix().asDiagonal();
    return relative_error(observations, sum);
  };
  const numerics::Lightcut cut =
      numerics::choose_lightcut(tree.tree, error, {options.error_threshold, options.min_size, options.max_size});
  LightCutResult result;
  result.error = cut.error;
  result.error_curve = cut.error_curve;
  result.nodes = cut.nodes;
  for (const int node : cut.nodes) result.lights.push_back(tree.representatives[node]);
  return result;
}

}  // namespace chiaro::inverse

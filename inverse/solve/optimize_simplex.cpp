// Chen, Lighting Design with Illumination Brush, 2008, section 3.4.3.

#include "inverse/solve/optimize_simplex.h"

#include "inverse/numerics/nelder_mead.h"

namespace chiaro::inverse {
namespace {

constexpr int kEvaluationsPerParameter = 250;
constexpr double kIntensityStep = 0.3;  // of the intensity
constexpr double kPositionStep = 0.5;   // of the grid's spacing

// At the nearest places where lights may stand.
LightEstimates unpack(const Eigen::VectorXd& x, const AllowedPlaces& places) {
  LightEstimates lights;
  for (Eigen::Index k = 0; k < x.size(); k += 6) {
    const Eigen::Vector3d position = x.segment<3>(k);
    if (const auto allowed = places.nearest(position)) lights.push_back({*allowed, x.segment<3>(k + 3).array()});
  }
  return lights;
}

}  // namespace

SimplexOptimum optimize_simplex(const LightResponse& response, const Observations& observations,
                                const LightEstimates& start, const std::function<bool()>& stop) {
  const auto n = Eigen::Index(6 * start.size());
  Eigen::VectorXd x(n), step(n), lower(n), upper(n);
  const Box3f region = response.grid().region;
  double brightest = 0;
  for (const LightEstimate& light : start) brightest = std::max(brightest, light.intensity.maxCoeff());
  for (std::size_t j = 0; j < start.size(); ++j) {
    for (int a = 0; a < 3; ++a) {
      const auto p = Eigen::Index(6 * j) + a, i = p + 3;
      const double spacing = double(response.grid().spacing[a]);
      x[p] = start[j].position[a];
      step[p] = spacing > 0 ? kPositionStep * spacing : 1e-6;
      lower[p] = double(region.min[a]);
      upper[p] = double(region.max[a]);
      x[i] = start[j].intensity[a];
      step[i] = kIntensityStep * std::max(start[j].intensity[a], 0.05 * brightest);
      lower[i] = 0;
      upper[i] = std::numeric_limits<double>::infinity();
    }
  }
  const auto error = [&](const Eigen::VectorXd& parameters) {
    const LightEstimates lights = unpack(parameters, response.places());
    const std::vector<Column> columns = evaluate_columns(response, lights, Evaluation::kTracedVisibility);
    return relative_error(observations, total_illumination(columns, lights, observations.wanted.rows()));
  };
  numerics::NelderMeadOptions options;
  options.max_evaluations = kEvaluationsPerParameter * int(n);
  options.value_tolerance = 1e-5;
  options.parameter_tolerance = 1e-3;
  options.stop = stop;
  const numerics::NelderMeadResult result = numerics::nelder_mead(error, x, step, lower, upper, options);
  return {unpack(result.x, response.places()), result.value, result.evaluations};
}

}  // namespace chiaro::inverse

#include "inverse/solve/settling_bench.h"

#include "inverse/solve/held_out.h"
#include "inverse/solve/instrumental_fit.h"

namespace chiaro::inverse {
namespace {

// So that none of the receivers counts more than others: in parts of its noise, which weights are by where it is known,
// or of its brightness.
Eigen::VectorXd comparable_residuals(const Observations& observations, const Column& illumination) {
  if (!(observations.noise > 0)) return relative_residuals(observations, illumination);
  return observations.sqrt_weight.cwiseProduct((illumination - observations.wanted).rowwise().norm());
}

}  // namespace

void SettlingBench::descend(const std::vector<Column>& indirect, LightEstimates& lights) const {
  descend_with_instruments(response, observations, indirect, lights, stop);
  fit_intensities_with_instruments(response, observations, indirect, lights);
}

Column SettlingBench::illumination(const std::vector<Column>& indirect, const LightEstimates& lights) const {
  return illumination_of(response, with_corrections(lights, indirect));
}

LightIntervals SettlingBench::intervals(const std::vector<Column>& indirect, const LightEstimates& lights) const {
  return intervals_with_instruments(response, observations, indirect, lights);
}

double SettlingBench::norm(const Column& light) const { return (observations.sqrt_weight.asDiagonal() * light).norm(); }

bool SettlingBench::explains_more(const Column& one, const Column& other, double gain, double standard_errors) const {
  const double error = relative_error(observations, one), of_other = relative_error(observations, other);
  return of_other * of_other > (1 + gain) * error * error &&
         clearly_smaller(comparable_residuals(observations, other), comparable_residuals(observations, one),
                         standard_errors);
}

}  // namespace chiaro::inverse

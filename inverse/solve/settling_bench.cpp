#include "inverse/solve/settling_bench.h"

#include "inverse/solve/held_out.h"
#include "inverse/solve/instrumental_fit.h"

namespace chiaro::inverse {
namespace {

constexpr double kFarBeyondNoise = 6;  // standard errors, of receivers of mean weight

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

bool SettlingBench::explains_more_to_most(const Column& one, const Column& other, double gain,
                                          double standard_errors) const {
  if (!(observations.noise > 0)) return explains_more(one, other, gain, standard_errors);
  const auto bounded = [&](const Column& illumination) {
    const Eigen::ArrayXd residuals = comparable_residuals(observations, illumination);
    return Eigen::VectorXd(residuals / (1 + (residuals / kFarBeyondNoise).square()).sqrt());
  };
  const Eigen::VectorXd residuals = bounded(one), of_other = bounded(other);
  return of_other.squaredNorm() > (1 + gain) * residuals.squaredNorm() &&
         clearly_smaller(of_other, residuals, standard_errors);
}

Observations SettlingBench::as_most_say(const Column& illumination) const {
  if (!(observations.noise > 0)) return observations;
  Observations weighted = observations;
  const Eigen::ArrayXd residuals = comparable_residuals(observations, illumination);
  weighted.sqrt_weight.array() /= 1 + (residuals / kFarBeyondNoise).square();
  weighted.measure_target();
  return weighted;
}

}  // namespace chiaro::inverse

#pragma once

#include <array>
#include <set>

#include "inverse/solve/known_directions.h"
#include "inverse/solve/observations.h"

namespace chiaro::inverse {

// Half widths of 90 % intervals, each parameter by itself.
struct LightInterval {
  Eigen::Vector3d position;  // metres, along x, y, z
  Eigen::Array3d intensity;  // candela per channel
};

struct LightIntervals {
  std::vector<LightInterval> lights;  // in their order
  // Of intensities only the sum is known: of the two, or of all that are linked by such pairs.
  std::vector<std::pair<std::size_t, std::size_t>> confounded;
};

// Of more nothing is computed: time and memory grow with their third and second power.
inline constexpr std::size_t kMostLightsWithIntervals = 100;

// Whether a light's colour has enough of a channel to say anything by; one that is dark may have any colour.
bool may_shine(const Eigen::Array3d& intensity, int channel);

// Of two intensities of one channel: what one light has more the other has less, by as much as the dimmer one shines,
// and their sum is known far better than each. Of none that is not known at all.
bool only_their_sum_is_known(double variance, double other_variance, double covariance, double dimmer);

// What a fit tells of the intensities of one channel: light l's is parameter first + step l.
struct IntensityErrors {
  const KnownDirections& directions;
  const Eigen::MatrixXd& covariance;  // infinite variances of what is not known
  Eigen::Index first, step;
};
// Adds the pairs of lights that may shine in the channel and of whose intensities only the sum is known.
void find_confounded(const IntensityErrors& errors, const std::vector<Eigen::Array3d>& intensity, int channel,
                     std::set<std::pair<std::size_t, std::size_t>>& pairs);

// All infinite.
LightIntervals unknown_intervals(std::size_t lights);

// How sure the least-squares lights are, from derivatives at fixed visibility and from what the fit leaves, which holds
// the noise of the target and the errors of transport alike; no noise need be known. Infinite where receivers tell
// nothing of a parameter, and for too many lights.
// Source: sandwich_estimate.h; a receiver's channels count as one cluster. MacKinnon, White, Some
// heteroskedasticity-consistent covariance matrix estimators with improved finite sample properties, 1985 (HC3); Bell,
// McCaffrey, Bias reduction in standard errors for linear regression with multi-stage samples, 2002.
LightIntervals light_intervals(const LightResponse& response, const Observations& observations,
                               const LightEstimates& lights);

// Of each channel: receivers × parameters. A light's parameters are x, y, z, red, green and blue.
using Derivatives = std::array<Eigen::MatrixXd, 3>;

// By intensities and by positions, as one channel shows them; columns[j] belongs to lights[j].
Derivatives derivatives_of(const std::vector<ColumnWithGradient>& columns, const LightEstimates& lights);

// A fit where it has come to rest: Σ weight · instrument · residual = 0 for each parameter.
struct FitAtRest {
  const Derivatives& derivatives;  // of the residual
  const Derivatives& instruments;  // the same for least squares
  const Column& residual;
  Eigen::VectorXd weight;
};
// The same of any such fit. Source: White, Instrumental Variables Regression with Independent Observations, 1982.
LightIntervals light_intervals(const FitAtRest& fit, const LightEstimates& lights);

}  // namespace chiaro::inverse

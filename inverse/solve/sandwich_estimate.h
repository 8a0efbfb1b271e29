#pragma once

#include "inverse/solve/known_directions.h"

namespace chiaro::inverse {

inline constexpr double kNinety = 1.645;  // standard deviations to either side, of a normal distribution

// How sure the parameters of a fit are, by what it leaves at each receiver, whose noise need not be known.
struct SandwichEstimate {
  Eigen::MatrixXd covariance;  // infinite variances of what is not known
  Eigen::VectorXd freedom;     // degrees of freedom that each variance is known by: 1, or more

  // Of a parameter's 90 % interval, by Student's distribution.
  double half_width(Eigen::Index parameter) const;
};

// pulls: receivers × parameters, how far each receiver's residual moves each parameter.
// Sources: White, A heteroskedasticity-consistent covariance matrix estimator and a direct test for heteroskedasticity,
// 1980. The few receivers beside a lamp may have nearly all to say of it; so many degrees of freedom does their noise
// leave: Satterthwaite, An Approximate Distribution of Estimates of Variance Components, 1946.
SandwichEstimate sandwich_estimate(const Eigen::MatrixXd& pulls, const KnownDirections& directions);

}  // namespace chiaro::inverse

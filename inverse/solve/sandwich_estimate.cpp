#include "inverse/solve/sandwich_estimate.h"

#include <cmath>
#include <limits>

namespace chiaro::inverse {
namespace {

// Half of an interval that holds 90 %, by Student's distribution, in standard deviations. Source: Abramowitz, Stegun,
// Handbook of Mathematical Functions, 1964, 26.7.5.
double standard_deviations(double freedom) {
  const double z = kNinety, z3 = std::pow(z, 3), z5 = std::pow(z, 5), z7 = std::pow(z, 7);
  return z + (z3 + z) / (4 * freedom) + (5 * z5 + 16 * z3 + 3 * z) / (96 * std::pow(freedom, 2)) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * std::pow(freedom, 3));
}

}  // namespace

double SandwichEstimate::half_width(Eigen::Index parameter) const {
  return standard_deviations(freedom[parameter]) * std::sqrt(covariance(parameter, parameter));
}

SandwichEstimate sandwich_estimate(const Eigen::MatrixXd& pulls, const KnownDirections& directions) {
  SandwichEstimate estimate;
  estimate.covariance = pulls.transpose() * pulls;
  const Eigen::ArrayXd fourth = pulls.array().square().square().colwise().sum();
  estimate.freedom = (estimate.covariance.diagonal().array().square() / fourth.max(1e-300)).max(1);
  for (Eigen::Index k = 0; k < pulls.cols(); ++k) {
    if (!directions.knows(k)) estimate.covariance(k, k) = std::numeric_limits<double>::infinity();
  }
  return estimate;
}

}  // namespace chiaro::inverse

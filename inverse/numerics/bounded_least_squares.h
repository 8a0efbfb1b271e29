#pragma once

#include <Eigen/Core>

namespace chiaro::inverse::numerics {

struct BoundedLeastSquares {
  Eigen::VectorXd x;        // 0 ≤ x ≤ upper
  double kkt_residual = 0;  // largest violation of the KKT conditions, of the system with columns of unit length
  int iterations = 0;
};

// argmin ‖A x − b‖² subject to 0 ≤ x ≤ upper (infinite: not bounded), from the normal equations gram = AᵀA and
// atb = Aᵀb, for few columns. Zero columns stay 0.
// Source: Stark, Parker, Bounded-variable least-squares: an algorithm and applications, 1995.
BoundedLeastSquares bounded_least_squares(const Eigen::MatrixXd& gram, const Eigen::VectorXd& atb,
                                          const Eigen::VectorXd& upper);

}  // namespace chiaro::inverse::numerics

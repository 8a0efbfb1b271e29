#pragma once

#include <Eigen/Core>

namespace chiaro::inverse::numerics {

struct NnlsOptions {
  int max_iterations = 0;  // 0: 10 × columns
  // Stop when max_j (Aᵀ(b − Ax))_j over x_j = 0, relative to max |Aᵀb|, is at most this; both with the columns of A
  // scaled to unit length, so that neither the unit nor the weight of a column matters.
  double kkt_tolerance = 1e-9;
};

struct NnlsResult {
  Eigen::MatrixXd x;        // columns × right-hand sides, all ≥ 0
  double kkt_residual = 0;  // largest violation of the KKT conditions over all right-hand sides, relative as above
  int iterations = 0;       // over all right-hand sides
  bool converged = false;   // kkt_residual ≤ kkt_tolerance
};

// argmin ‖A x − b‖² subject to x ≥ 0, from the normal equations: gram = AᵀA (n × n, symmetric), atb = Aᵀb (n × k, one
// column per right-hand side, each solved by itself). Rank-deficient and badly scaled systems, zero columns and more
// columns than rows are fine. Optional warm start: a feasible x of the same shape.
// Source: Bro & De Jong, A fast non-negativity-constrained least squares algorithm, 1997; Lawson & Hanson 1974.
NnlsResult nnls(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& atb, const NnlsOptions& options = {},
                const Eigen::MatrixXd* warm_start = nullptr);

}  // namespace chiaro::inverse::numerics

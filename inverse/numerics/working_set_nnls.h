#pragma once

#include "inverse/numerics/nnls.h"

namespace chiaro::inverse::numerics {

// As nnls(), of A (m × n) and b (m × k) themselves, where few of many columns end up with x > 0: products are taken
// only of columns that could, a fraction of AᵀA. The KKT residual is that of A and b, without the rounding of AᵀA.
// Source: Johnson & Guestrin, Blitz: a principled meta-algorithm for scaling sparse optimization, 2015 (working sets);
// here the columns that violate the KKT conditions most come into the set, and none leaves it.
NnlsResult working_set_nnls(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, const NnlsOptions& options = {},
                            const Eigen::MatrixXd* warm_start = nullptr);

}  // namespace chiaro::inverse::numerics

#pragma once

#include <functional>
#include <string>

#include <Eigen/Core>

namespace chiaro::inverse::numerics {

struct NelderMeadOptions {
  int max_evaluations = 2000;
  double value_tolerance = 1e-9;      // stop when f(worst) − f(best) ≤ value_tolerance × (|f(best)| + 1e-30) …
  double parameter_tolerance = 1e-6;  // … and every vertex is within this of the best, relative to `step`
  bool restart = true;                // once, around the best, with a tenth of the steps
  std::function<bool()> stop{};       // if any, asked before each step: whether it is to be the last
};

struct NelderMeadResult {
  Eigen::VectorXd x;
  double value = 0;
  int evaluations = 0;
  bool converged = false;
};

// Downhill simplex from x0 with initial edges step[i] (> 0), adaptive coefficients in high dimension; bounds lower ≤ x
// ≤ upper by projection. Values that are not finite count as +∞. Source: Nelder & Mead, A simplex method for function
// minimization, 1965; coefficients of Gao & Han, 2012.
NelderMeadResult nelder_mead(const std::function<double(const Eigen::VectorXd&)>& f, const Eigen::VectorXd& x0,
                             const Eigen::VectorXd& step, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                             const NelderMeadOptions& options = {});

}  // namespace chiaro::inverse::numerics

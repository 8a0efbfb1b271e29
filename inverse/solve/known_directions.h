#pragma once

#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace chiaro::inverse {

// What a fit tells of its parameters, and what it does not.
struct KnownDirections {
  Eigen::MatrixXd basis;    // parameters × directions that it tells something of
  Eigen::MatrixXd unknown;  // parameters × parameters: the projection on all others, the parameters times 1 / scale
  Eigen::VectorXd scale;    // that gives the normal matrix a diagonal of ones; 0 where it has 0

  bool knows(Eigen::Index parameter) const;
};

// By the directions of a symmetric normal matrix, its eigenvectors when it is scaled so. tells: whether an eigenvalue,
// above rounding, and its direction, in the parameters' units, tell something.
KnownDirections known_directions(
    const Eigen::MatrixXd& normal, const std::function<bool(double, const Eigen::VectorXd&)>& tells =
                                       [](double, const Eigen::VectorXd&) { return true; });

// Of these parameters, the pairs (by their places in the list) of groups that are not known, but for their sum.
std::vector<std::pair<std::size_t, std::size_t>> pairs_known_by_sum(const KnownDirections& directions,
                                                                    const std::vector<Eigen::Index>& parameters);

}  // namespace chiaro::inverse

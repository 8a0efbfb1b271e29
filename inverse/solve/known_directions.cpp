#include "inverse/solve/known_directions.h"

#include <cmath>

#include "inverse/numerics/decompositions.h"

namespace chiaro::inverse {
namespace {

constexpr double kRounding = 1e-10;    // eigenvalue, of a matrix of unit diagonal: nothing is known in that direction
constexpr double kWhollySeen = 0.999;  // of a parameter, or a sum, by the directions that are known
constexpr double kOpposed = 0.02;      // correlation of two that are unknown, and less than its negative

using Group = std::vector<std::size_t>;

// Those that have less where the first, or another of them, has more.
std::vector<Group> opposed(const KnownDirections& directions, const std::vector<Eigen::Index>& parameters) {
  const auto shared = [&](std::size_t j, std::size_t k) {
    const Eigen::Index a = parameters[j], b = parameters[k];
    const double both = std::sqrt(directions.unknown(a, a) * directions.unknown(b, b));
    return directions.unknown(a, b) < -kOpposed * both;
  };
  std::vector<bool> taken;
  for (const Eigen::Index parameter : parameters) {
    taken.push_back(!(directions.scale[parameter] > 0) || directions.knows(parameter));
  }
  std::vector<Group> groups;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    if (taken[j]) continue;
    Group group{j};
    taken[j] = true;
    for (std::size_t next = 0; next < group.size(); ++next) {
      for (std::size_t k = 0; k < parameters.size(); ++k) {
        if (taken[k] || !shared(group[next], k)) continue;
        taken[k] = true;
        group.push_back(k);
      }
    }
    if (group.size() > 1) groups.push_back(std::move(group));
  }
  return groups;
}

bool knows_sum(const KnownDirections& directions, const std::vector<Eigen::Index>& parameters, const Group& group) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(directions.scale.size());
  for (const std::size_t j : group) sum[parameters[j]] = directions.scale[parameters[j]];
  return sum.dot(directions.unknown * sum) <= (1 - kWhollySeen) * sum.squaredNorm();
}

}  // namespace

bool KnownDirections::knows(Eigen::Index parameter) const {
  return scale[parameter] > 0 && unknown(parameter, parameter) <= 1 - kWhollySeen;
}

KnownDirections known_directions(const Eigen::MatrixXd& normal,
                                 const std::function<bool(double, const Eigen::VectorXd&)>& tells) {
  KnownDirections result;
  result.scale = normal.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0; });
  const numerics::Eigendecomposition eigen =
      numerics::symmetric_eigen(result.scale.asDiagonal() * normal * result.scale.asDiagonal());
  std::vector<Eigen::Index> known;
  for (Eigen::Index e = 0; e < normal.rows(); ++e) {
    const double value = eigen.values[e];
    if (value > kRounding && tells(value, result.scale.cwiseProduct(eigen.vectors.col(e)))) known.push_back(e);
  }
  const Eigen::MatrixXd directions = eigen.vectors(Eigen::all, known);
  result.basis = result.scale.asDiagonal() * directions;
  result.unknown = Eigen::MatrixXd::Identity(normal.rows(), normal.rows()) - directions * directions.transpose();
  return result;
}

std::vector<std::pair<std::size_t, std::size_t>> pairs_known_by_sum(const KnownDirections& directions,
                                                                    const std::vector<Eigen::Index>& parameters) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const Group& group : opposed(directions, parameters)) {
    if (!knows_sum(directions, parameters, group)) continue;
    for (const std::size_t j : group) {
      for (const std::size_t k : group) {
        if (j < k) pairs.emplace_back(j, k);
      }
    }
  }
  return pairs;
}

}  // namespace chiaro::inverse

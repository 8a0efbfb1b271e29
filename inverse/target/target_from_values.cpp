#include "inverse/target/target_from_values.h"

#include <algorithm>
#include <cmath>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include "inverse/numerics/median.h"
#include "inverse/target/receiver_lookup.h"
#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/error.h"

namespace chiaro::inverse {
namespace {

using Eigen::Index;
using Colors = Eigen::Matrix<double, Eigen::Dynamic, 3>;
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

// Of the local mean beside the values, so that a receiver seen by hardly any follows them all.
constexpr double kTowardsMean = 0.1;
constexpr double kTolerance = 1e-8;  // relative residual of the linear system, or less
// Variance of an interpolating fit against that of the mean of the values around a receiver, on regular triangles.
constexpr double kFitVariance = 3.5;
constexpr double kMuchScatter = 2;  // times the common one: what noise does not explain
constexpr std::size_t kValuesAtOnce = 1 << 20;

struct PlacedValue {
  ReceiverWeights at;
  Vec3f illumination;
  double weight = 0;
  std::size_t number = 0;  // among the values given
};

std::vector<PlacedValue> place(const Receivers& receivers, std::span<const SurfaceValue> values,
                               const renderer::Control& control) {
  const ReceiverLookup lookup(receivers);
  std::vector<std::optional<ReceiverWeights>> at(values.size());
  renderer::parallel_for(values.size(), "placing values", control, [&](std::size_t s) {
    if (values[s].weight > 0) at[s] = lookup.find(values[s].position, values[s].normal);
  });
  std::vector<PlacedValue> placed;
  for (std::size_t s = 0; s < values.size(); ++s) {
    if (at[s]) placed.push_back({*at[s], values[s].illumination, values[s].weight, s});
  }
  return placed;
}

// Weighted sums over the values around each receiver.
struct Sums {
  Eigen::VectorXd weight, weight_squared;
  Colors illumination;
};

Sums sums_of(const std::vector<PlacedValue>& values, Index receivers) {
  Sums sums{Eigen::VectorXd::Zero(receivers), Eigen::VectorXd::Zero(receivers), Colors::Zero(receivers, 3)};
  for (const PlacedValue& value : values) {
    for (int k = 0; k < 3; ++k) {
      const double w = value.weight * double(value.at.weights[k]);
      sums.weight[value.at.receivers[k]] += w;
      sums.weight_squared[value.at.receivers[k]] += w * w;
      sums.illumination.row(value.at.receivers[k]) += w * to_eigen(value.illumination).transpose();
    }
  }
  return sums;
}

Colors means_of(const Sums& sums) {
  Colors means = sums.illumination;
  for (Index i = 0; i < means.rows(); ++i) {
    if (sums.weight[i] > 0) means.row(i) /= sums.weight[i];
  }
  return means;
}

using Entries = std::vector<Eigen::Triplet<double>>;

SparseMatrix matrix_of(const Entries& entries, Index receivers) {
  SparseMatrix matrix(receivers, receivers);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

void append_products(const PlacedValue& value, Entries& entries) {
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 3; ++l) {
      const double w = value.weight * double(value.at.weights[k]) * double(value.at.weights[l]);
      entries.emplace_back(int(value.at.receivers[k]), int(value.at.receivers[l]), w);
    }
  }
}

// Of the weighted squares between values and interpolation, and of kTowardsMean times those between receivers and
// means. Summed up in parts, as there may be many more values than receivers.
SparseMatrix normal_matrix(const std::vector<PlacedValue>& values, const Sums& sums) {
  Entries entries;
  for (Index i = 0; i < sums.weight.size(); ++i) {
    entries.emplace_back(int(i), int(i), sums.weight[i] > 0 ? kTowardsMean * sums.weight[i] : 1);
  }
  SparseMatrix normal = matrix_of(entries, sums.weight.size());
  for (std::size_t first = 0; first < values.size(); first += kValuesAtOnce) {
    entries.clear();
    for (std::size_t i = first; i < std::min(first + kValuesAtOnce, values.size()); ++i) {
      append_products(values[i], entries);
    }
    normal += matrix_of(entries, sums.weight.size());
  }
  return normal;
}

// Values at receivers, none negative.
Colors fit(const std::vector<PlacedValue>& values, const Sums& sums) {
  const Colors means = means_of(sums);
  const SparseMatrix normal = normal_matrix(values, sums);
  Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower | Eigen::Upper> solver(normal);
  solver.setTolerance(kTolerance);
  const Colors wanted = sums.illumination + kTowardsMean * sums.weight.asDiagonal() * means;
  Colors fitted = means;
  for (int c = 0; c < 3; ++c) {
    const Eigen::VectorXd channel = solver.solveWithGuess(wanted.col(c), means.col(c));
    if (channel.allFinite()) fitted.col(c) = channel.cwiseMax(0);
  }
  return fitted;
}

Eigen::RowVector3d interpolated(const Colors& at_receivers, const ReceiverWeights& at) {
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (int k = 0; k < 3; ++k) sum += double(at.weights[k]) * at_receivers.row(at.receivers[k]);
  return sum;
}

// Mean square of what the interpolation leaves of the values around each receiver, over the channels.
Eigen::VectorXd scatter_around(const std::vector<PlacedValue>& values, const Sums& sums, const Colors& fitted) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(sums.weight.size());
  for (const PlacedValue& value : values) {
    const Eigen::RowVector3d left = to_eigen(value.illumination).transpose() - interpolated(fitted, value.at);
    for (int k = 0; k < 3; ++k) {
      squares[value.at.receivers[k]] += value.weight * double(value.at.weights[k]) * left.squaredNorm() / 3;
    }
  }
  return (sums.weight.array() > 0).select(squares.array() / sums.weight.array(), 0);
}

// Root mean square over the channels. The values' noise is taken to be relative, and the median of their scatter; what
// is beyond it, as across the edge of a shadow, no interpolation shows: it does not average out.
std::vector<float> standard_errors(const std::vector<PlacedValue>& values, const Sums& sums, const Colors& fitted) {
  const Eigen::VectorXd scatter = scatter_around(values, sums, fitted);
  const Eigen::VectorXd light = fitted.rowwise().squaredNorm() / 3;
  std::vector<double> relative;
  for (Index i = 0; i < light.size(); ++i) {
    if (sums.weight[i] > 0 && light[i] > 0) relative.push_back(scatter[i] / light[i]);
  }
  const double noise = numerics::median(std::move(relative));
  std::vector<float> errors(std::size_t(sums.weight.size()), 0);
  for (Index i = 0; i < sums.weight.size(); ++i) {
    if (!(sums.weight[i] > 0)) continue;
    const double count = std::max(1.0, sums.weight[i] * sums.weight[i] / sums.weight_squared[i]);
    const double of_noise = noise * light[i], not_shown = std::max(0.0, scatter[i] - kMuchScatter * of_noise);
    errors[std::size_t(i)] = float(std::sqrt(kFitVariance * of_noise / count + not_shown));
  }
  return errors;
}

// Of each receiver the value nearest to it, by barycentric coordinates.
std::vector<const PlacedValue*> nearest_values(const std::vector<PlacedValue>& values, std::size_t receivers) {
  std::vector<const PlacedValue*> nearest(receivers, nullptr);
  std::vector<float> nearness(receivers, 0);
  for (const PlacedValue& value : values) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t i = value.at.receivers[k];
      if (value.at.weights[k] <= nearness[i]) continue;
      nearness[i] = value.at.weights[k];
      nearest[i] = &value;
    }
  }
  return nearest;
}

renderer::SurfaceSample sample_at(const Receivers& receivers, const ReceiverWeights& at, const SurfaceValue& value) {
  Vec3f normal;
  float rounding = 0;
  for (int k = 0; k < 3; ++k) {
    normal += at.weights[k] * receivers.normals[at.receivers[k]];
    rounding = std::max(rounding, receivers.samples[at.receivers[k]].stand_off);
  }
  return {renderer::offset_point(value.position, value.normal, rounding),
          length(normal) > 0 ? normalize(normal) : value.normal, rounding};
}

// Illumination is taken where values are, and not where nothing is known: a receiver under the edge of what stands
// before it is not lit as what is seen beside it.
void move_samples(std::span<const SurfaceValue> values, const std::vector<PlacedValue>& placed, const Colors& fitted,
                  Target& target) {
  const std::vector<const PlacedValue*> nearest = nearest_values(placed, target.receivers.size());
  target.receivers.samples.resize(target.receivers.size());
  target.receivers.samples_moved = true;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (nearest[i] == nullptr) continue;
    target.receivers.samples[i] = sample_at(target.receivers, nearest[i]->at, values[nearest[i]->number]);
    target.illumination[i] = to_vec3f(Eigen::Vector3d(interpolated(fitted, nearest[i]->at)));
  }
}

// 1 on average where it is not 0.
std::vector<float> normalized(const Eigen::VectorXd& weight) {
  const double mean = weight.sum() / std::max<double>(1, double((weight.array() > 0).count()));
  std::vector<float> result(std::size_t(weight.size()), 0);
  for (Index i = 0; i < weight.size() && mean > 0; ++i) result[std::size_t(i)] = float(weight[i] / mean);
  return result;
}

}  // namespace

TargetFromValues target_from_values(const Receivers& receivers, std::span<const SurfaceValue> values,
                                    const renderer::Control& control) {
  const std::vector<PlacedValue> placed = place(receivers, values, control);
  const Sums sums = sums_of(placed, Index(receivers.size()));
  const Colors fitted = fit(placed, sums);
  TargetFromValues result;
  result.target.receivers = receivers;
  for (Index i = 0; i < fitted.rows(); ++i) {
    result.target.illumination.push_back(to_vec3f(Eigen::Vector3d(fitted.row(i))));
  }
  move_samples(values, placed, fitted, result.target);
  result.target.weight = normalized(sums.weight);
  result.target.standard_error = standard_errors(placed, sums, fitted);
  const auto given = std::count_if(values.begin(), values.end(), [](const SurfaceValue& v) { return v.weight > 0; });
  result.not_placed = std::size_t(given) - placed.size();
  return result;
}

Target combine(const Target& a, const Target& b) {
  CHIARO_CHECK(a.receivers.size() == b.receivers.size());
  Target sum = a;
  sum.receivers.samples_moved = a.receivers.samples_moved || b.receivers.samples_moved;
  const bool errors = !a.standard_error.empty() && !b.standard_error.empty();
  if (!errors) sum.standard_error.clear();
  for (std::size_t i = 0; i < sum.illumination.size(); ++i) {
    const float total = a.weight[i] + b.weight[i];
    if (!(total > 0)) continue;
    const float part = b.weight[i] / total;
    if (part > 0.5F) sum.receivers.samples[i] = b.receivers.samples[i];
    sum.illumination[i] = lerp(part, a.illumination[i], b.illumination[i]);
    sum.weight[i] = total;
    if (errors) sum.standard_error[i] = std::hypot((1 - part) * a.standard_error[i], part * b.standard_error[i]);
  }
  return sum;
}

}  // namespace chiaro::inverse

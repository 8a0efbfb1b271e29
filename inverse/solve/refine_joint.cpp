// Joint descent over all lights: Denoyelle, Duval, Peyré, Soubies, The sliding Frank–Wolfe algorithm, 2019, step 5;
// Levenberg–Marquardt by Ceres over the positions alone. Intensities are the best ones wherever the lights stand
// (variable projection): Golub, Pereyra, The differentiation of pseudo-inverses and nonlinear least squares problems
// whose variables separate, 1973, with the Jacobian of Kaufman, A variable projection method for solving separable
// nonlinear least squares problems, 1975.

#include "inverse/solve/refine_joint.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <ceres/ceres.h>
#include <glog/logging.h>

#include "inverse/numerics/decompositions.h"
#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

constexpr double kAtLimit = 1 - 1e-6;  // of the greatest intensity, or more: it is kept
constexpr double kFaintest = 1e-6;     // of the target's norm: a light that is damped like any other
constexpr double kRounding = 1e-14;    // of the largest eigenvalue, or less: none

// What Ceres is told of metres and of cd/m²: its tolerances are absolute. Positions are in parts of the region's
// diagonal, from its centre; residuals in parts of the target's norm.
struct Units {
  Eigen::Vector3d center;
  double diagonal, norm;

  Units(const LightResponse& response, const Observations& observations)
      : center(to_eigen(response.grid().region.center())),
        diagonal(std::max(double(response.grid().region.diagonal()), std::numeric_limits<double>::min())),
        norm(observations.target_norm > 0 ? observations.target_norm : 1) {}

  std::vector<Eigen::Vector3d> positions(const double* parameters, std::size_t lights) const {
    std::vector<Eigen::Vector3d> positions;
    for (std::size_t j = 0; j < lights; ++j) {
      positions.emplace_back(center + diagonal * Eigen::Map<const Eigen::Vector3d>(parameters + 3 * j));
    }
    return positions;
  }
  void set_parameters(const std::vector<Eigen::Vector3d>& positions, double* parameters) const {
    for (std::size_t j = 0; j < positions.size(); ++j) {
      Eigen::Map<Eigen::Vector3d>(parameters + 3 * j) = (positions[j] - center) / diagonal;
    }
  }
};

// What a step needs to know of the residuals r and their derivatives J.
struct NormalEquations {
  Eigen::MatrixXd squared_jacobian;  // JᵀJ
  Eigen::VectorXd gradient;          // Jᵀr
};

// Residuals of all receivers and channels under lights at some places, whose intensities are the best ones there; and
// how they change as the lights move (x, y, z of each), less what intensities make good as far as they may change.
class LightsAtPlaces {
 public:
  LightsAtPlaces(const LightResponse& response, const Observations& observations, const LightEstimates& start)
      : response_(response), observations_(observations), start_(start) {}

  // Ceres asks for the derivatives where it has asked for the residuals alone before, wherever a step led downwards:
  // they come with the rays that were traced for the latter.
  void move_to(const std::vector<Eigen::Vector3d>& positions) {
    if (positions == at_) return;
    columns_.resize(start_.size());
    renderer::parallel_for(columns_.size(), [&](std::size_t j) {
      columns_[j] = response_.evaluate_with_gradient(positions[j], Evaluation::kTracedVisibility);
      if (start_[j].correction.size() > 0) columns_[j].value += start_[j].correction;
    });
    std::vector<Column> values;
    for (const ColumnWithGradient& column : columns_) values.push_back(column.value);
    fit_ = fit_intensities(observations_, values);
    residual_ = total_illumination(values, fit_.intensity, receivers()) - observations_.wanted;
    residual_.array().colwise() *= observations_.sqrt_weight.array();
    at_ = positions;
  }

  const std::vector<Eigen::Array3d>& intensities() const { return fit_.intensity; }
  double residual_norm() const { return residual_.norm(); }

  NormalEquations normal_equations() const {
    const Eigen::Index unknowns = Eigen::Index(3 * columns_.size());
    NormalEquations sum{Eigen::MatrixXd::Zero(unknowns, unknowns), Eigen::VectorXd::Zero(unknowns)};
    if (observations_.rules.color_is_ruled()) {
      Eigen::MatrixXd moved(3 * receivers(), unknowns);
      for (int c = 0; c < 3; ++c) fill_moved(c, moved.middleRows(c * receivers(), receivers()));
      add(ruled_changes(), moved, residual_.reshaped(), sum);
      return sum;
    }
    for (int c = 0; c < 3; ++c) {
      Eigen::MatrixXd moved(receivers(), unknowns);
      fill_moved(c, moved);
      add(free_columns(c), moved, residual_.col(c), sum);
    }
    return sum;
  }

 private:
  Eigen::Index receivers() const { return observations_.wanted.rows(); }

  // What a move changes in one channel.
  void fill_moved(int channel, Eigen::Ref<Eigen::MatrixXd> moved) const {
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      for (int a = 0; a < 3; ++a) {
        moved.col(Eigen::Index(3 * j) + a) =
            fit_.intensity[j][channel] * observations_.sqrt_weight.cwiseProduct(columns_[j].gradient[a].col(channel));
      }
    }
  }

  // Of the lights whose intensity may go up and down.
  Eigen::MatrixXd free_columns(int channel) const {
    Eigen::MatrixXd free(receivers(), Eigen::Index(columns_.size()));
    Eigen::Index count = 0;
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      const double intensity = fit_.intensity[j][channel];
      if (!(intensity > 0 && intensity < kAtLimit * observations_.rules.max_intensity)) continue;
      free.col(count++) = observations_.sqrt_weight.cwiseProduct(columns_[j].value.col(channel));
    }
    return free.leftCols(count);
  }

  // Of all channels, one below the other.
  Eigen::MatrixXd ruled_changes() const {
    Eigen::MatrixXd changes = Eigen::MatrixXd::Zero(3 * receivers(), Eigen::Index(fit_.directions.size()));
    for (std::size_t k = 0; k < fit_.directions.size(); ++k) {
      for (std::size_t j = 0; j < columns_.size(); ++j) {
        for (int c = 0; c < 3; ++c) {
          changes.col(Eigen::Index(k)).segment(c * receivers(), receivers()) +=
              fit_.directions[k](Eigen::Index(j), c) * observations_.sqrt_weight.cwiseProduct(columns_[j].value.col(c));
        }
      }
    }
    return changes;
  }

  // J = (I − Q Qᵀ) moved, where Q is an orthonormal basis of the changes that intensities make.
  static void add(const Eigen::MatrixXd& changes, const Eigen::MatrixXd& moved, const Eigen::VectorXd& residual,
                  NormalEquations& sum) {
    sum.squared_jacobian.selfadjointView<Eigen::Lower>().rankUpdate(moved.transpose());
    sum.gradient += moved.transpose() * residual;
    if (changes.cols() == 0) return;
    const Eigen::MatrixXd basis = numerics::orthonormal_basis(changes);
    const Eigen::MatrixXd along = basis.transpose() * moved;
    sum.squared_jacobian.selfadjointView<Eigen::Lower>().rankUpdate(along.transpose(), -1);
    sum.gradient -= along.transpose() * (basis.transpose() * residual).eval();
  }

  const LightResponse& response_;
  const Observations& observations_;
  const LightEstimates& start_;  // for the corrections
  // Where the lights were last, and what they do there.
  std::vector<Eigen::Vector3d> at_;
  std::vector<ColumnWithGradient> columns_;
  IntensityFit fit_;
  Column residual_;  // weighted
};

// As Ceres sees it: as many residuals as unknowns and one more, with the same cost, gradient and JᵀJ as those of all
// receivers, so that its steps are the same and none of its products as long as the receivers are many. With
// JᵀJ = V D Vᵀ they are D^½ Vᵀ in the unknowns, D^−½ Vᵀ Jᵀr in value, and what is left of ‖r‖. One parameter block: x,
// y, z of each light.
class CondensedResiduals final : public ceres::CostFunction {
 public:
  CondensedResiduals(LightsAtPlaces& lights, const Units& units, int unknowns) : lights_(lights), units_(units) {
    set_num_residuals(unknowns + 1);
    mutable_parameter_block_sizes()->push_back(unknowns);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const int unknowns = num_residuals() - 1;
    lights_.move_to(units_.positions(parameters[0], std::size_t(unknowns / 3)));
    const double norm = lights_.residual_norm() / units_.norm;
    Eigen::Map<Eigen::VectorXd> out(residuals, unknowns + 1);
    out.setZero();
    out[unknowns] = norm;
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    NormalEquations normal = lights_.normal_equations();
    const double per_unit = units_.diagonal / units_.norm;
    normal.squared_jacobian *= per_unit * per_unit;
    normal.gradient *= per_unit / units_.norm;
    const numerics::Eigendecomposition eigen = numerics::symmetric_eigen(normal.squared_jacobian);
    const Eigen::VectorXd along = eigen.vectors.transpose() * normal.gradient;
    Eigen::Map<Jacobian> jacobian(jacobians[0], unknowns + 1, unknowns);
    jacobian.setZero();
    const double least = kRounding * eigen.values.maxCoeff();
    for (int k = 0; k < unknowns; ++k) {
      const double value = eigen.values[k];
      if (!(value > least)) continue;
      jacobian.row(k) = std::sqrt(value) * eigen.vectors.col(k).transpose();
      out[k] = along[k] / std::sqrt(value);
    }
    out[unknowns] = std::sqrt(std::max(0.0, norm * norm - out.head(unknowns).squaredNorm()));
    return true;
  }

 private:
  using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  LightsAtPlaces& lights_;
  const Units& units_;
};

// Steps that lead where lights may not stand end at the nearest place where they may, or where they began.
class AllowedPositions final : public ceres::Manifold {
 public:
  AllowedPositions(const AllowedPlaces& places, const Units& units, std::size_t lights)
      : places_(places), units_(units), size_(int(3 * lights)) {}

  int AmbientSize() const override { return size_; }
  int TangentSize() const override { return size_; }
  bool Plus(const double* x, const double* delta, double* result) const override {
    Eigen::Map<Eigen::VectorXd> sum(result, size_);
    sum = Eigen::Map<const Eigen::VectorXd>(x, size_) + Eigen::Map<const Eigen::VectorXd>(delta, size_);
    const std::vector<Eigen::Vector3d> wanted = units_.positions(result, std::size_t(size_ / 3));
    std::vector<Eigen::Vector3d> positions = wanted;
    if (!places_.settle(positions)) {
      sum = Eigen::Map<const Eigen::VectorXd>(x, size_);
    } else if (positions != wanted) {
      units_.set_parameters(positions, result);
    }
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override { return identity(jacobian); }
  bool Minus(const double* y, const double* x, double* difference) const override {
    Eigen::Map<Eigen::VectorXd>(difference, size_) =
        Eigen::Map<const Eigen::VectorXd>(y, size_) - Eigen::Map<const Eigen::VectorXd>(x, size_);
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override { return identity(jacobian); }

 private:
  bool identity(double* jacobian) const {
    Eigen::Map<Eigen::MatrixXd>(jacobian, size_, size_).setIdentity();
    return true;
  }

  const AllowedPlaces& places_;
  const Units& units_;
  int size_;
};

ceres::Solver::Options solver_options(const JointRefinementOptions& options) {
  ceres::Solver::Options o;
  o.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  o.max_num_iterations = options.max_iterations;
  o.function_tolerance = options.function_tolerance;
  o.gradient_tolerance = 1e-12;
  o.min_lm_diagonal = kFaintest * kFaintest;
  // From the first step on short enough that most lead downwards.
  o.initial_trust_region_radius = 10;
  o.parameter_tolerance = 1e-7;
  // Shadow edges make the cost rough: a rise along the way to a deeper valley is allowed.
  o.use_nonmonotonic_steps = true;
  o.logging_type = ceres::SILENT;
  o.num_threads = 1;
  return o;
}

// Ceres writes to standard error where it gives up, whatever its options say.
bool silence_ceres() {
  FLAGS_minloglevel = google::FATAL;
  return true;
}

}  // namespace

JointRefinement refine_joint(const LightResponse& response, const Observations& observations,
                             const LightEstimates& start, const JointRefinementOptions& options) {
  JointRefinement result;
  if (start.empty()) {
    result.error = relative_error(observations, Column::Zero(observations.wanted.rows(), 3));
    return result;
  }
  std::vector<Eigen::Vector3d> positions = positions_of(start);
  if (!response.places().settle(positions)) {
    result.error = std::numeric_limits<double>::infinity();
    return result;
  }
  result.lights = start;
  const Units units(response, observations);
  std::vector<double> parameters(3 * start.size());
  units.set_parameters(positions, parameters.data());
  ceres::Problem problem;
  problem.AddParameterBlock(parameters.data(), int(parameters.size()),
                            new AllowedPositions(response.places(), units, start.size()));
  LightsAtPlaces lights(response, observations, start);
  problem.AddResidualBlock(new CondensedResiduals(lights, units, int(parameters.size())), nullptr, parameters.data());
  [[maybe_unused]] static const bool silent = silence_ceres();
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(options), &problem, &summary);
  const std::vector<Eigen::Vector3d> reached = units.positions(parameters.data(), start.size());
  positions = reached;
  if (!response.places().settle(positions)) positions = reached;
  lights.move_to(positions);
  for (std::size_t j = 0; j < start.size(); ++j) {
    result.lights[j].position = positions[j];
    result.lights[j].intensity = lights.intensities()[j];
  }
  result.error = lights.residual_norm() / observations.target_norm;
  result.iterations = int(summary.iterations.size());
  return result;
}

void lead_lights(const LightResponse& response, const Observations& observations, const JointRefinementOptions& options,
                 LightEstimates& lights) {
  LightEstimates led = refine_joint(response, observations, lights, options).lights;
  if (!led.empty()) lights = std::move(led);
  for (LightEstimate& light : lights) light.correction = Column();
}

}  // namespace chiaro::inverse

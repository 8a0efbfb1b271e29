// Joint descent over all lights: Denoyelle, Duval, Peyré, Soubies, The sliding Frank–Wolfe algorithm, 2019, step 5;
// Levenberg–Marquardt by Ceres over the positions alone. Intensities are the best ones wherever the lights stand
// (variable projection): Golub, Pereyra, The differentiation of pseudo-inverses and nonlinear least squares problems
// whose variables separate, 1973, with the Jacobian of Kaufman, A variable projection method for solving separable
// nonlinear least squares problems, 1975.

#include "inverse/solve/refine_joint.h"

#include <limits>

#include <ceres/ceres.h>
#include <glog/logging.h>
#include <Eigen/QR>

#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

constexpr double kAtLimit = 1 - 1e-6;  // of the greatest intensity, or more: it is kept

// Residuals of all receivers and channels, row 'channel · receivers + receiver'; one parameter block: x, y, z (metres)
// of each light.
class IlluminationResiduals final : public ceres::CostFunction {
 public:
  IlluminationResiduals(const LightResponse& response, const Observations& observations, const LightEstimates& start)
      : response_(response), observations_(observations), start_(start) {
    set_num_residuals(int(3 * observations.wanted.rows()));
    mutable_parameter_block_sizes()->push_back(int(3 * start.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    move_to(parameters[0]);
    Eigen::Map<Column> out(residuals, observations_.wanted.rows(), 3);
    out = -observations_.wanted;
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      out += columns_[j].value * fit_.intensity[j].matrix().asDiagonal();
    }
    out = observations_.sqrt_weight.asDiagonal() * out;
    if (jacobians != nullptr && jacobians[0] != nullptr) fill_jacobian(columns_, fit_, jacobians[0]);
    return true;
  }

  // The best ones of lights that stand there.
  const std::vector<Eigen::Array3d>& intensities(const double* parameters) const {
    move_to(parameters);
    return fit_.intensity;
  }

 private:
  // Ceres asks for the Jacobian where it has asked for the residuals alone before, wherever a step led downwards:
  // gradients come with the rays that were traced for the latter.
  void move_to(const double* parameters) const {
    const std::vector<double> at(parameters, parameters + 3 * start_.size());
    if (at == at_) return;
    columns_.resize(start_.size());
    renderer::parallel_for(columns_.size(), [&](std::size_t j) {
      const Eigen::Vector3d position(parameters + 3 * j);
      columns_[j] = response_.evaluate_with_gradient(position, Evaluation::kTracedVisibility);
      if (start_[j].correction.size() > 0) columns_[j].value += start_[j].correction;
    });
    std::vector<Column> values;
    for (const ColumnWithGradient& column : columns_) values.push_back(column.value);
    fit_ = fit_intensities(observations_, values);
    at_ = at;
  }

  using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  // What a move changes, less what intensities make good as far as they may change.
  void fill_jacobian(const std::vector<ColumnWithGradient>& columns, const IntensityFit& fit, double* jacobian) const {
    const Eigen::Index receivers = observations_.wanted.rows(), lights = Eigen::Index(columns.size());
    Eigen::Map<Jacobian> out(jacobian, 3 * receivers, 3 * lights);
    for (int c = 0; c < 3; ++c) {
      Eigen::MatrixXd moved = moved_by(columns, fit, c);
      if (!observations_.rules.color_is_ruled()) take_off(free_columns(columns, fit, c), moved);
      out.middleRows(c * receivers, receivers) = moved;
    }
    if (!observations_.rules.color_is_ruled() || fit.directions.empty()) return;
    Eigen::MatrixXd all = out;
    take_off(ruled_changes(columns, fit), all);
    out = all;
  }

  // Receivers × 3 lights.
  Eigen::MatrixXd moved_by(const std::vector<ColumnWithGradient>& columns, const IntensityFit& fit, int channel) const {
    Eigen::MatrixXd moved(observations_.wanted.rows(), Eigen::Index(3 * columns.size()));
    for (std::size_t j = 0; j < columns.size(); ++j) {
      for (int a = 0; a < 3; ++a) {
        moved.col(Eigen::Index(3 * j) + a) =
            fit.intensity[j][channel] * observations_.sqrt_weight.cwiseProduct(columns[j].gradient[a].col(channel));
      }
    }
    return moved;
  }

  // Of the lights whose intensity may go up and down.
  Eigen::MatrixXd free_columns(const std::vector<ColumnWithGradient>& columns, const IntensityFit& fit,
                               int channel) const {
    Eigen::MatrixXd free(observations_.wanted.rows(), Eigen::Index(columns.size()));
    Eigen::Index count = 0;
    for (std::size_t j = 0; j < columns.size(); ++j) {
      const double intensity = fit.intensity[j][channel];
      if (!(intensity > 0 && intensity < kAtLimit * observations_.rules.max_intensity)) continue;
      free.col(count++) = observations_.sqrt_weight.cwiseProduct(columns[j].value.col(channel));
    }
    return free.leftCols(count);
  }

  // Of all channels, one below the other.
  Eigen::MatrixXd ruled_changes(const std::vector<ColumnWithGradient>& columns, const IntensityFit& fit) const {
    const Eigen::Index receivers = observations_.wanted.rows();
    Eigen::MatrixXd changes = Eigen::MatrixXd::Zero(3 * receivers, Eigen::Index(fit.directions.size()));
    for (std::size_t k = 0; k < fit.directions.size(); ++k) {
      for (std::size_t j = 0; j < columns.size(); ++j) {
        for (int c = 0; c < 3; ++c) {
          changes.col(Eigen::Index(k)).segment(c * receivers, receivers) +=
              fit.directions[k](Eigen::Index(j), c) * observations_.sqrt_weight.cwiseProduct(columns[j].value.col(c));
        }
      }
    }
    return changes;
  }

  static void take_off(const Eigen::MatrixXd& changes, Eigen::MatrixXd& moved) {
    if (changes.cols() == 0) return;
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(changes);
    const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(changes.rows(), qr.rank());
    moved -= basis * (basis.transpose() * moved).eval();
  }

  const LightResponse& response_;
  const Observations& observations_;
  const LightEstimates& start_;  // for the corrections
  // Where the lights were last, and what they do there.
  mutable std::vector<double> at_;
  mutable std::vector<ColumnWithGradient> columns_;
  mutable IntensityFit fit_;
};

std::vector<Eigen::Vector3d> positions_of(const double* x, int size) {
  std::vector<Eigen::Vector3d> positions;
  for (int k = 0; k < size; k += 3) positions.emplace_back(x + k);
  return positions;
}

// Steps that lead where lights may not stand end at the nearest place where they may, or where they began.
class AllowedPositions final : public ceres::Manifold {
 public:
  AllowedPositions(const AllowedPlaces& places, std::size_t lights) : places_(places), size_(int(3 * lights)) {}

  int AmbientSize() const override { return size_; }
  int TangentSize() const override { return size_; }
  bool Plus(const double* x, const double* delta, double* result) const override {
    Eigen::Map<Eigen::VectorXd> sum(result, size_);
    sum = Eigen::Map<const Eigen::VectorXd>(x, size_) + Eigen::Map<const Eigen::VectorXd>(delta, size_);
    std::vector<Eigen::Vector3d> positions = positions_of(result, size_);
    if (!places_.settle(positions)) positions = positions_of(x, size_);
    for (std::size_t j = 0; j < positions.size(); ++j) sum.segment<3>(Eigen::Index(3 * j)) = positions[j];
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
  int size_;
};

ceres::Solver::Options solver_options(const JointRefinementOptions& options) {
  ceres::Solver::Options o;
  o.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  o.max_num_iterations = options.max_iterations;
  o.function_tolerance = options.function_tolerance;
  o.gradient_tolerance = 1e-12;
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
    result.termination = "no lights";
    return result;
  }
  std::vector<Eigen::Vector3d> positions;
  for (const LightEstimate& light : start) positions.push_back(light.position);
  if (!response.places().settle(positions)) {
    result.error = std::numeric_limits<double>::infinity();
    result.termination = "no place for all lights";
    return result;
  }
  result.lights = start;
  ceres::Problem problem;
  double* const parameters = positions.front().data();
  problem.AddParameterBlock(parameters, int(3 * start.size()), new AllowedPositions(response.places(), start.size()));
  auto* const residuals = new IlluminationResiduals(response, observations, start);  // owned by the problem
  problem.AddResidualBlock(residuals, nullptr, parameters);
  [[maybe_unused]] static const bool silent = silence_ceres();
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(options), &problem, &summary);
  const std::vector<Eigen::Array3d>& intensities = residuals->intensities(parameters);
  for (std::size_t j = 0; j < start.size(); ++j) {
    result.lights[j].position = positions[j];
    result.lights[j].intensity = intensities[j];
  }
  result.error = std::sqrt(2 * summary.final_cost) / observations.target_norm;
  result.iterations = int(summary.iterations.size());
  result.termination = ceres::TerminationTypeToString(summary.termination_type);
  return result;
}

}  // namespace chiaro::inverse

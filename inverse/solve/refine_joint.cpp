// Joint descent over all lights: Denoyelle, Duval, Peyré, Soubies, The sliding Frank–Wolfe algorithm, 2019, step 5;
// Levenberg–Marquardt by Ceres over the positions alone. Intensities are the best ones wherever the lights stand
// (variable projection): Golub, Pereyra, The differentiation of pseudo-inverses and nonlinear least squares problems
// whose variables separate, 1973, with the Jacobian of Kaufman, A variable projection method for solving separable
// nonlinear least squares problems, 1975.

#include "inverse/solve/refine_joint.h"

#include <ceres/ceres.h>
#include <Eigen/QR>

#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

// Residuals of all receivers and channels, row 'channel · receivers + receiver'; one parameter block, x, y, z (metres),
// per light.
class IlluminationResiduals final : public ceres::CostFunction {
 public:
  IlluminationResiduals(const LightResponse& response, const Observations& observations, const LightEstimates& start)
      : response_(response), observations_(observations), start_(start) {
    set_num_residuals(int(3 * observations.wanted.rows()));
    for (std::size_t j = 0; j < start.size(); ++j) mutable_parameter_block_sizes()->push_back(3);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const std::vector<ColumnWithGradient> columns = columns_at(parameters, jacobians != nullptr);
    std::vector<Column> values;
    for (const ColumnWithGradient& column : columns) values.push_back(column.value);
    const IntensityFit fit = fit_intensities(observations_, values);
    Eigen::Map<Column> out(residuals, observations_.wanted.rows(), 3);
    out = -observations_.wanted;
    for (std::size_t j = 0; j < values.size(); ++j) out += values[j] * fit.intensity[j].matrix().asDiagonal();
    out = observations_.sqrt_weight.asDiagonal() * out;
    for (int c = 0; jacobians != nullptr && c < 3; ++c) fill_jacobian(columns, fit, c, jacobians);
    return true;
  }

 private:
  std::vector<ColumnWithGradient> columns_at(double const* const* parameters, bool with_gradient) const {
    std::vector<ColumnWithGradient> columns(start_.size());
    renderer::parallel_for(columns.size(), [&](std::size_t j) {
      const Eigen::Vector3d position(parameters[j]);
      if (with_gradient) {
        columns[j] = response_.evaluate_with_gradient(position, Evaluation::kTracedVisibility);
      } else {
        columns[j].value = response_.evaluate(position, Evaluation::kTracedVisibility);
      }
      if (start_[j].correction.size() > 0) columns[j].value += start_[j].correction;
    });
    return columns;
  }

  // What a move changes, less what intensities of the lights that shine make good.
  void fill_jacobian(const std::vector<ColumnWithGradient>& columns, const IntensityFit& fit, int channel,
                     double** jacobians) const {
    const Eigen::Index receivers = observations_.wanted.rows(), lights = Eigen::Index(columns.size());
    Eigen::MatrixXd moved(receivers, 3 * lights), lit(receivers, lights);
    Eigen::Index lit_count = 0;
    for (Eigen::Index j = 0; j < lights; ++j) {
      const ColumnWithGradient& column = columns[std::size_t(j)];
      const double intensity = fit.intensity[std::size_t(j)][channel];
      for (int a = 0; a < 3; ++a) {
        moved.col(3 * j + a) = intensity * observations_.sqrt_weight.cwiseProduct(column.gradient[a].col(channel));
      }
      if (intensity > 0) {
        lit.col(lit_count++) = observations_.sqrt_weight.cwiseProduct(column.value.col(channel));
      }
    }
    if (lit_count > 0) {
      const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(lit.leftCols(lit_count));
      const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(receivers, qr.rank());
      moved -= basis * (basis.transpose() * moved).eval();
    }
    using Block = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
    for (Eigen::Index j = 0; j < lights; ++j) {
      if (jacobians[j] == nullptr) continue;
      Eigen::Map<Block>(jacobians[j] + channel * receivers * 3, receivers, 3) = moved.middleCols<3>(3 * j);
    }
  }

  const LightResponse& response_;
  const Observations& observations_;
  const LightEstimates& start_;  // for the corrections
};

void set_bounds(ceres::Problem& problem, double* block, const Box3f& region) {
  for (int a = 0; a < 3; ++a) {
    const double low = double(region.min[a]), high = double(region.max[a]);
    block[a] = std::clamp(block[a], low, high);
    // A region that is flat along an axis fixes that coordinate; Ceres wants room between bounds.
    problem.SetParameterLowerBound(block, a, low);
    problem.SetParameterUpperBound(block, a, std::max(high, low + 1e-9));
  }
}

ceres::Solver::Options solver_options(const JointRefinementOptions& options) {
  ceres::Solver::Options o;
  o.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  o.max_num_iterations = options.max_iterations;
  o.function_tolerance = options.function_tolerance;
  o.gradient_tolerance = 1e-12;
  o.parameter_tolerance = 1e-7;
  // Shadow edges make the cost rough: a rise along the way to a deeper valley is allowed.
  o.use_nonmonotonic_steps = true;
  // Steps that end at the region's border are cut off there: searching along them takes more than half of the time.
  o.max_num_line_search_step_size_iterations = 0;
  o.logging_type = ceres::SILENT;
  o.num_threads = 1;
  return o;
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
  result.lights = start;
  ceres::Problem problem;
  std::vector<double*> blocks;
  for (LightEstimate& light : result.lights) blocks.push_back(light.position.data());
  problem.AddResidualBlock(new IlluminationResiduals(response, observations, start), nullptr, blocks);
  for (double* block : blocks) set_bounds(problem, block, response.grid().region);
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(options), &problem, &summary);
  const IntensityFit fit =
      fit_intensities(observations, evaluate_columns(response, result.lights, Evaluation::kTracedVisibility));
  for (std::size_t j = 0; j < start.size(); ++j) result.lights[j].intensity = fit.intensity[j];
  result.error = std::sqrt(2 * summary.final_cost) / observations.target_norm;
  result.iterations = int(summary.iterations.size());
  result.termination = ceres::TerminationTypeToString(summary.termination_type);
  return result;
}

}  // namespace chiaro::inverse

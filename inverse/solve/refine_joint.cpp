// Joint descent over all lights: Denoyelle, Duval, Peyré, Soubies, The sliding Frank–Wolfe algorithm, 2019, step 5;
// Levenberg–Marquardt by Ceres.

#include "inverse/solve/refine_joint.h"

#include <ceres/ceres.h>

#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

constexpr int kLightParameters = 6;  // x, y, z (metres), red, green, blue (candela)

// Residuals of all receivers and channels; one parameter block per light.
class IlluminationResiduals final : public ceres::CostFunction {
 public:
  IlluminationResiduals(const LightResponse& response, const Observations& observations, const LightEstimates& start)
      : response_(response), observations_(observations), start_(start), light_count_(start.size()) {
    set_num_residuals(int(3 * observations.wanted.rows()));
    for (std::size_t j = 0; j < light_count_; ++j) mutable_parameter_block_sizes()->push_back(kLightParameters);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index m = observations_.wanted.rows();
    std::vector<ColumnWithGradient> columns(light_count_);
    renderer::parallel_for(light_count_, [&](std::size_t j) {
      const Eigen::Vector3d position(parameters[j]);
      if (jacobians != nullptr) {
        columns[j] = response_.evaluate_with_gradient(position, Evaluation::kTracedVisibility);
      } else {
        columns[j].value = response_.evaluate(position, Evaluation::kTracedVisibility);
      }
      if (start_[j].correction.size() > 0) columns[j].value += start_[j].correction;
    });
    Eigen::Map<Column> out(residuals, m, 3);
    out = -observations_.wanted;
    for (std::size_t j = 0; j < light_count_; ++j) {
      out += columns[j].value * Eigen::Map<const Eigen::Vector3d>(parameters[j] + 3).asDiagonal();
    }
    out = observations_.sqrt_weight.asDiagonal() * out;
    for (std::size_t j = 0; jacobians != nullptr && j < light_count_; ++j) {
      if (jacobians[j] != nullptr) fill_jacobian(columns[j], parameters[j] + 3, jacobians[j]);
    }
    return true;
  }

 private:
  // Row 'channel · m + receiver'; row-major, as Ceres has it.
  void fill_jacobian(const ColumnWithGradient& column, const double* intensity, double* jacobian) const {
    const Eigen::Index m = observations_.wanted.rows();
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, kLightParameters, Eigen::RowMajor>> out(jacobian, 3 * m,
                                                                                             kLightParameters);
    out.setZero();
    for (int c = 0; c < 3; ++c) {
      auto rows = out.middleRows(c * m, m);
      for (int a = 0; a < 3; ++a) {
        rows.col(a) = intensity[c] * observations_.sqrt_weight.cwiseProduct(column.gradient[a].col(c));
      }
      rows.col(3 + c) = observations_.sqrt_weight.cwiseProduct(column.value.col(c));
    }
  }

  const LightResponse& response_;
  const Observations& observations_;
  const LightEstimates& start_;  // for the corrections
  std::size_t light_count_;
};

using Parameters = std::array<double, kLightParameters>;

void set_bounds(ceres::Problem& problem, double* block, const Box3f& region) {
  for (int a = 0; a < 3; ++a) {
    const double low = double(region.min[a]), high = double(region.max[a]);
    block[a] = std::clamp(block[a], low, high);
    // A region that is flat along an axis fixes that coordinate; Ceres wants room between bounds.
    problem.SetParameterLowerBound(block, a, low);
    problem.SetParameterUpperBound(block, a, std::max(high, low + 1e-9));
    problem.SetParameterLowerBound(block, 3 + a, 0);
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
  std::vector<Parameters> parameters(start.size());
  std::vector<double*> blocks;
  for (std::size_t j = 0; j < start.size(); ++j) {
    Eigen::Map<Eigen::Vector3d>(parameters[j].data()) = start[j].position;
    Eigen::Map<Eigen::Array3d>(parameters[j].data() + 3) = start[j].intensity;
    blocks.push_back(parameters[j].data());
  }
  ceres::Problem problem;
  problem.AddResidualBlock(new IlluminationResiduals(response, observations, start), nullptr, blocks);
  for (double* block : blocks) set_bounds(problem, block, response.grid().region);
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(options), &problem, &summary);
  for (std::size_t j = 0; j < start.size(); ++j) {
    const Parameters& p = parameters[j];
    result.lights.push_back({Eigen::Vector3d(p.data()), Eigen::Array3d(p[3], p[4], p[5]), start[j].correction});
  }
  result.error = std::sqrt(2 * summary.final_cost) / observations.target_norm;
  result.iterations = int(summary.iterations.size());
  result.termination = ceres::TerminationTypeToString(summary.termination_type);
  return result;
}

}  // namespace chiaro::inverse

#include "inverse/solve/settle_positions.h"

#include <limits>

#include "inverse/numerics/nelder_mead.h"
#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

constexpr int kCycles = 2;
constexpr int kEvaluations = 80;  // per light and cycle

class Settling {
 public:
  Settling(const LightResponse& response, const Observations& observations, const LightEstimates& start)
      : response_(response),
        observations_(observations),
        columns_(evaluate_columns(response, start, Evaluation::kTracedVisibility)),
        best_{start, relative_error(observations, total_illumination(columns_, start, observations.wanted.rows())), 0} {
  }

  void settle(std::size_t moved, double step, const std::function<bool()>& stop) {
    const Box3f region = response_.grid().region;
    numerics::NelderMeadOptions options;
    options.max_evaluations = kEvaluations;
    options.restart = false;
    options.stop = stop;
    numerics::nelder_mead([&](const Eigen::VectorXd& position) { return error_with(moved, position); },
                          best_.lights[moved].position, Eigen::VectorXd::Constant(3, step), to_eigen(region.min),
                          to_eigen(region.max), options);
    columns_[moved] = evaluate_column(response_, best_.lights[moved], Evaluation::kTracedVisibility);
  }

  const SettledLights& best() const { return best_; }

 private:
  // At the nearest allowed place, if that is far enough from all others.
  bool place(std::size_t moved, const Eigen::Vector3d& position, LightEstimates& lights) const {
    const auto allowed = response_.places().nearest(position);
    if (!allowed) return false;
    lights[moved].position = *allowed;
    std::vector<Eigen::Vector3d> positions;
    for (const LightEstimate& light : lights) positions.push_back(light.position);
    return response_.places().far_apart(positions);
  }

  double error_with(std::size_t moved, const Eigen::Vector3d& position) {
    ++best_.evaluations;
    LightEstimates lights = best_.lights;
    if (!place(moved, position, lights)) return std::numeric_limits<double>::infinity();
    columns_[moved] = evaluate_column(response_, lights[moved], Evaluation::kTracedVisibility);
    const double error = refit_intensities(observations_, columns_, lights);
    if (error < best_.error) best_.lights = std::move(lights), best_.error = error;
    return error;
  }

  const LightResponse& response_;
  const Observations& observations_;
  std::vector<Column> columns_;  // at the positions last tried
  SettledLights best_;
};

}  // namespace

SettledLights settle_positions(const LightResponse& response, const Observations& observations,
                               const LightEstimates& start, double step, const std::function<bool()>& stop) {
  Settling settling(response, observations, start);
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    for (std::size_t j = 0; j < start.size(); ++j) {
      if (stop && stop()) return settling.best();
      settling.settle(j, step, stop);
    }
  }
  return settling.best();
}

}  // namespace chiaro::inverse

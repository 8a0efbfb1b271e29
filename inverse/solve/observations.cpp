#include "inverse/solve/observations.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "inverse/numerics/median.h"
#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

constexpr double kOrdinary = 0.97;              // of all receivers are as bright as lights at a distance make them
constexpr double kShadows = 0.01;               // relative error of transport at least: shadows' edges
constexpr double kLinearBelow = 216.0 / 24389;  // relative luminance up to which L* is linear
constexpr double kPainted = 0.02;               // of the usual noise, or less: paint has none, and is a wish …
constexpr double kWished = 0.25;                // … which is to be met as what has so much of it
constexpr double kDark = 0.1;                   // in mean brightness: darker receivers count as being as bright

// The brightness that this part of all receivers do not exceed. Of those that have any: paint may leave most of a scene
// black.
double quantile(const Eigen::VectorXd& brightness, const Eigen::VectorXd& stands_for, double part) {
  std::vector<Eigen::Index> order;
  double all = 0;
  for (Eigen::Index i = 0; i < brightness.size(); ++i) {
    if (brightness[i] > 0) order.push_back(i), all += stands_for[i];
  }
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return brightness[a] < brightness[b]; });
  double below = 0;
  const double wanted = part * all;
  for (const Eigen::Index i : order) {
    below += stands_for[i];
    if (below >= wanted) return brightness[i];
  }
  return order.empty() ? 0 : brightness[order.back()];
}

// Of receivers whose noise is known.
double typical(const Eigen::VectorXd& standard_error) {
  std::vector<double> known;
  std::copy_if(standard_error.begin(), standard_error.end(), std::back_inserter(known), [](double e) { return e > 0; });
  return numerics::median(std::move(known));
}

}  // namespace

LightEstimates::iterator brightest_light(LightEstimates& lights) {
  return std::max_element(lights.begin(), lights.end(),
                          [](const auto& a, const auto& b) { return a.intensity.maxCoeff() < b.intensity.maxCoeff(); });
}

void put_out_residue(LightEstimates& lights) {
  constexpr double kResidue = 1e-9;  // of the brightest
  if (lights.empty()) return;
  const double brightest = brightest_light(lights)->intensity.maxCoeff();
  for (LightEstimate& light : lights) {
    if (light.intensity.maxCoeff() < kResidue * brightest) light.intensity.setZero();
  }
}

renderer::PointLight point_light(const LightEstimate& estimate) {
  renderer::PointLight light;
  light.position = to_vec3f(estimate.position);
  light.intensity = to_vec3f(estimate.intensity.matrix());
  return light;
}

renderer::Lights point_lights(const LightEstimates& estimates) {
  renderer::Lights lights;
  for (const LightEstimate& estimate : estimates) lights.emplace_back(point_light(estimate));
  return lights;
}

LightEstimates light_estimates(const std::vector<renderer::PointLight>& lights) {
  LightEstimates estimates;
  for (const renderer::PointLight& light : lights) {
    estimates.push_back({to_eigen(light.position), to_eigen(light.intensity).array()});
  }
  return estimates;
}

std::vector<Vec3f> light_positions(const LightEstimates& lights) {
  std::vector<Vec3f> positions;
  for (const LightEstimate& light : lights) positions.push_back(to_vec3f(light.position));
  return positions;
}

std::vector<Eigen::Vector3d> positions_of(const LightEstimates& lights) {
  std::vector<Eigen::Vector3d> positions;
  for (const LightEstimate& light : lights) positions.push_back(light.position);
  return positions;
}

void Observations::measure_target() {
  target_norm = (sqrt_weight.asDiagonal() * target).norm();
  noise = target_norm > 0 ? std::sqrt(3.0) * sqrt_weight.cwiseProduct(standard_error).norm() / target_norm : 0;
}

Observations with_capped_weights(const Observations& observations) {
  const Eigen::VectorXd brightness = observations.target.rowwise().norm();
  const double cap = quantile(brightness, observations.stands_for, kOrdinary);
  Observations capped = observations;
  for (Eigen::Index i = 0; i < brightness.size(); ++i) {
    if (brightness[i] > cap) capped.sqrt_weight[i] *= cap / brightness[i];
  }
  capped.measure_target();
  return capped;
}

Observations weighted_by_noise(const Observations& observations, double transport_error) {
  const Eigen::ArrayXd brightness = observations.target.rowwise().norm();
  const Eigen::ArrayXd by_transport = std::max(kShadows, transport_error) * brightness.max(kDark * brightness.mean());
  const double usual = typical(observations.standard_error);
  const Eigen::ArrayXd noise = observations.standard_error.unaryExpr(
      [&](double error) { return error < kPainted * usual ? kWished * usual : error; });
  Observations weighted = observations;
  weighted.sqrt_weight.array() /= (3 * noise.square() + by_transport.square()).sqrt();
  weighted.measure_target();
  return weighted;
}

Observations in_mean_weights(const Observations& observations) {
  const double mean = observations.sqrt_weight.size() > 0 ? observations.sqrt_weight.cwiseAbs2().mean() : 0;
  if (!(mean > 0)) return observations;
  Observations relative = observations;
  relative.sqrt_weight /= std::sqrt(mean);
  relative.measure_target();
  return relative;
}

Observations weighted_by_objective(const Observations& observations, Objective objective) {
  if (objective == Objective::kL2) return observations;
  const Eigen::VectorXd y = observations.target * Eigen::Vector3d(0.2126, 0.7152, 0.0722);
  const double white = quantile(y, observations.stands_for, kOrdinary);
  if (!(white > 0)) return observations;
  Observations weighted = observations;
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const double relative = y[i] / white;
    weighted.sqrt_weight[i] *= objective == Objective::kRelative ? 1 / std::max(relative, kDark)
                                                                 : std::pow(std::max(relative, kLinearBelow), -2.0 / 3);
  }
  weighted.measure_target();
  return weighted;
}

Observations standing_for_all(const Observations& observations) {
  Observations all = observations;
  all.sqrt_weight.array() *= observations.stands_for.array().sqrt();
  all.measure_target();
  return all;
}

Observations rows_of(const Observations& observations, const std::vector<std::size_t>& rows) {
  Observations some;
  some.wanted = observations.wanted(rows, Eigen::all);
  some.target = observations.target(rows, Eigen::all);
  some.sqrt_weight = observations.sqrt_weight(rows);
  some.stands_for = observations.stands_for(rows);
  some.standard_error = observations.standard_error(rows);
  some.rules = observations.rules;
  some.measure_target();
  return some;
}

double contribution_norm(const Observations& observations, const Column& column, const Eigen::Array3d& intensity) {
  return (observations.sqrt_weight.asDiagonal() * column * intensity.matrix().asDiagonal()).norm();
}

Column column_of(const std::vector<Vec3f>& values) {
  Column column(Eigen::Index(values.size()), 3);
  for (std::size_t i = 0; i < values.size(); ++i) column.row(Eigen::Index(i)) = to_eigen(values[i]).transpose();
  return column;
}

Column total_illumination(const std::vector<Column>& columns, const std::vector<Eigen::Array3d>& intensity,
                          Eigen::Index receivers) {
  Column sum = Column::Zero(receivers, 3);
  for (std::size_t j = 0; j < intensity.size(); ++j) sum += columns[j] * intensity[j].matrix().asDiagonal();
  return sum;
}

Column total_illumination(const std::vector<Column>& columns, const LightEstimates& lights, Eigen::Index receivers) {
  std::vector<Eigen::Array3d> intensity;
  for (const LightEstimate& light : lights) intensity.push_back(light.intensity);
  return total_illumination(columns, intensity, receivers);
}

double relative_error(const Observations& observations, const Column& illumination) {
  const double norm = (observations.sqrt_weight.asDiagonal() * (illumination - observations.wanted)).norm();
  return norm / observations.target_norm;
}

Eigen::VectorXd relative_residuals(const Observations& observations, const Column& illumination) {
  const Eigen::ArrayXd brightness = observations.target.rowwise().norm();
  return observations.sqrt_weight.array() * (illumination - observations.wanted).rowwise().norm().array() /
         brightness.max(kDark * brightness.mean());
}

std::array<WeightedSystem, 3> weighted_systems(const Observations& observations, const std::vector<Column>& columns) {
  std::array<WeightedSystem, 3> channels;
  renderer::parallel_for(3, [&](std::size_t channel) {
    const auto c = Eigen::Index(channel);
    WeightedSystem& system = channels[channel];
    system.a.resize(observations.wanted.rows(), Eigen::Index(columns.size()));
    for (std::size_t j = 0; j < columns.size(); ++j) {
      system.a.col(Eigen::Index(j)) = observations.sqrt_weight.cwiseProduct(columns[j].col(c));
    }
    system.b = observations.sqrt_weight.cwiseProduct(observations.wanted.col(c));
  });
  return channels;
}

IntensityFit fit_intensities(const Observations& observations, const std::vector<Column>& columns) {
  return fit_intensities(weighted_systems(observations, columns), observations.rules);
}

double refit_intensities(const Observations& observations, const std::vector<Column>& columns, LightEstimates& lights) {
  const IntensityFit fit = fit_intensities(observations, columns);
  for (std::size_t j = 0; j < lights.size(); ++j) lights[j].intensity = fit.intensity[j];
  return relative_error(observations, total_illumination(columns, lights, observations.wanted.rows()));
}

double effective_part(const Eigen::VectorXd& energy, const Eigen::VectorXd& stands_for) {
  const double squared = energy.cwiseAbs2().cwiseQuotient(stands_for).sum();
  return squared > 0 ? energy.sum() * energy.sum() / squared / stands_for.sum() : 1;
}

Column evaluate_column(const LightResponse& response, const LightEstimate& light, Evaluation evaluation) {
  Column column = response.evaluate(light.position, evaluation);
  if (light.correction.size() > 0) column += light.correction;
  return column;
}

std::vector<Column> evaluate_columns(const LightResponse& response, const LightEstimates& lights,
                                     Evaluation evaluation) {
  std::vector<Column> columns(lights.size());
  renderer::parallel_for(lights.size(),
                         [&](std::size_t j) { columns[j] = evaluate_column(response, lights[j], evaluation); });
  return columns;
}

std::vector<ColumnWithGradient> evaluate_columns_with_gradient(const LightResponse& response,
                                                               const LightEstimates& lights) {
  std::vector<ColumnWithGradient> columns(lights.size());
  renderer::parallel_for(lights.size(), [&](std::size_t j) {
    columns[j] = response.evaluate_with_gradient(lights[j].position, Evaluation::kTracedVisibility);
    if (lights[j].correction.size() > 0) columns[j].value += lights[j].correction;
  });
  return columns;
}

LightEstimates with_corrections(LightEstimates lights, const std::vector<Column>& corrections) {
  for (std::size_t j = 0; j < lights.size(); ++j) lights[j].correction = corrections[j];
  return lights;
}

Column illumination_of(const LightResponse& response, const LightEstimates& lights) {
  const std::vector<Column> columns = evaluate_columns(response, lights, Evaluation::kTracedVisibility);
  return total_illumination(columns, lights, Eigen::Index(response.receiver_count()));
}

Observations less(Observations observations, const LightResponse& response, const LightEstimates& lights) {
  observations.wanted -= illumination_of(response, lights);
  return observations;
}

}  // namespace chiaro::inverse

#pragma once
// What a solve fits: wanted illumination at the important vertices, and lights that may produce it.

#include <algorithm>
#include <limits>
#include <vector>

#include "inverse/solve/intensity_rules.h"
#include "inverse/transport/light_response.h"

namespace chiaro::inverse {

// At the important vertices. residual of receiver i, channel c = sqrt_weight[i] · (Σ_j l_jc φ_j(i, c) − wanted(i, c)).
struct Observations {
  Column wanted;  // cd/m², the fixed part (emission, kept lights) taken off
  Eigen::VectorXd sqrt_weight;
  Eigen::VectorXd stands_for;      // of how many receivers each is drawn as the sample
  Column target;                   // Ψ, cd/m², with the fixed part
  Eigen::VectorXd standard_error;  // of Ψ, cd/m²; 0 where it is not known
  double target_norm = 0;          // √Σ weight · Ψ²: the denominator of (3.6)
  double noise = 0;                // relative error that the standard errors give; 0: not known
  IntensityRules rules{};          // what intensities may explain them

  // target_norm and noise, of the other members.
  void measure_target();
};

// The same with the few receivers right beside a light, which would hide all other light, weighted down in proportion
// to their brightness.
Observations with_capped_weights(const Observations& observations);

// The same with weights by how well each receiver is known: its standard error, and the relative error of transport.
Observations weighted_by_noise(const Observations& observations, double transport_error);

// The same, whatever unit weights are given in.
Observations in_mean_weights(const Observations& observations);

// How a receiver's error counts.
enum class Objective : std::uint8_t {
  kL2,          // as (3.6) has it
  kRelative,    // in parts of what is wanted there
  kPerceptual,  // as lightness (CIE 1976 L*) changes with luminance there, white being the brightest of most receivers
};

// The same with weights by an objective. Lightness is taken as linear about the target.
Observations weighted_by_objective(const Observations& observations, Objective objective);

// The same with weights by which the important vertices stand for all receivers.
Observations standing_for_all(const Observations& observations);

// What some of the receivers say.
Observations rows_of(const Observations& observations, const std::vector<std::size_t>& rows);

// A light being sought.
struct LightEstimate {
  Eigen::Vector3d position;  // metres
  Eigen::Array3d intensity;  // candela per channel, ≥ 0
  Column correction{};       // added to its unity response wherever it moves; empty: none
  // Where the correction was made exact; nowhere: it was not.
  Eigen::Vector3d corrected_at = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
};
using LightEstimates = std::vector<LightEstimate>;

inline bool is_dark(const LightEstimate& light) { return !(light.intensity > 0).any(); }

// By its brightest channel; end() of none.
LightEstimates::iterator brightest_light(LightEstimates& lights);

// Lights that shine by what rounding left of them go dark.
void put_out_residue(LightEstimates& lights);

renderer::PointLight point_light(const LightEstimate& estimate);
renderer::Lights point_lights(const LightEstimates& estimates);
LightEstimates light_estimates(const std::vector<renderer::PointLight>& lights);
std::vector<Vec3f> light_positions(const LightEstimates& lights);
std::vector<Eigen::Vector3d> positions_of(const LightEstimates& lights);

// ‖ weighted column times intensity ‖: the light's contribution (3.5).
double contribution_norm(const Observations& observations, const Column& column, const Eigen::Array3d& intensity);

// One row per value.
Column column_of(const std::vector<Vec3f>& values);

// Illumination of all lights together; columns[j] belongs to intensity[j], or to lights[j].
Column total_illumination(const std::vector<Column>& columns, const std::vector<Eigen::Array3d>& intensity,
                          Eigen::Index receivers);
Column total_illumination(const std::vector<Column>& columns, const LightEstimates& lights, Eigen::Index receivers);

// D(I(p), Ψ) of eq. (3.6) over the important vertices.
double relative_error(const Observations& observations, const Column& illumination);

// What each receiver lacks or has too much, relative to its brightness: none of them counts more than others.
Eigen::VectorXd relative_residuals(const Observations& observations, const Column& illumination);

// Columns and what is wanted of them in each channel, weighted as the observations have it.
std::array<WeightedSystem, 3> weighted_systems(const Observations& observations, const std::vector<Column>& columns);

// The intensities that fit fixed columns best, by the observations' rules.
IntensityFit fit_intensities(const Observations& observations, const std::vector<Column>& columns);

// Of how large a part of all receivers a squared norm speaks: (Σ e)² / Σ e² over their count, estimated from receivers
// that stand for them. energy: what each of these adds to the norm, in the name of all that it stands for.
double effective_part(const Eigen::VectorXd& energy, const Eigen::VectorXd& stands_for);

// Gives the lights the intensities that fit their columns best. Returns the error that is left, (3.6).
double refit_intensities(const Observations& observations, const std::vector<Column>& columns, LightEstimates& lights);

// Of sets of lights with their errors, those of the least errors: at most so many, best first.
template <class SetWithError>
std::vector<SetWithError> best_of(std::vector<SetWithError> sets, std::size_t most) {
  std::stable_sort(sets.begin(), sets.end(), [](const auto& a, const auto& b) { return a.error < b.error; });
  sets.resize(std::min(most, sets.size()));
  return sets;
}

// The same, their lights alone.
template <class SetWithError>
std::vector<LightEstimates> best_sets(std::vector<SetWithError> sets, std::size_t most) {
  std::vector<LightEstimates> best;
  for (SetWithError& set : best_of(std::move(sets), most)) best.push_back(std::move(set.lights));
  return best;
}

// Column of a light with its correction.
Column evaluate_column(const LightResponse& response, const LightEstimate& light, Evaluation evaluation);

// Those of all lights, evaluated in parallel.
std::vector<Column> evaluate_columns(const LightResponse& response, const LightEstimates& lights,
                                     Evaluation evaluation);

// The same with derivatives, visibility traced.
std::vector<ColumnWithGradient> evaluate_columns_with_gradient(const LightResponse& response,
                                                               const LightEstimates& lights);

// Each with a correction of its own.
LightEstimates with_corrections(LightEstimates lights, const std::vector<Column>& corrections);

// Of all lights together, by traced visibility and with their corrections.
Column illumination_of(const LightResponse& response, const LightEstimates& lights);

// With the light of these lights taken off what is wanted.
Observations less(Observations observations, const LightResponse& response, const LightEstimates& lights);

}  // namespace chiaro::inverse

#pragma once
// What a user lets intensities be, and the best that keep to it.

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace chiaro::inverse {

struct IntensityRules {
  double max_intensity = std::numeric_limits<double>::infinity();  // candela, of any channel
  bool one_color = false;                                          // all lights have the same
  std::optional<std::array<double, 2>> kelvin;                     // all are black bodies of from … to

  // A light whose brightest channel has so many candela is, but for a hundredth, as bright as it may be.
  bool limits(double brightest) const { return brightest >= 0.99 * max_intensity; }
  bool color_is_ruled() const { return one_color || kelvin; }
  bool any() const { return color_is_ruled() || max_intensity < std::numeric_limits<double>::infinity(); }
};

// Of the lights' intensities in one colour channel.
struct WeightedSystem {
  Eigen::MatrixXd a;  // columns of unity lights
  Eigen::VectorXd b;  // what is wanted
};

// The same as least squares ask for it.
struct NormalEquations {
  Eigen::MatrixXd gram;  // AᵀA
  Eigen::VectorXd atb;   // Aᵀb
};

struct IntensityFit {
  std::vector<Eigen::Array3d> intensity;
  double kkt_residual = 0;
  int iterations = 0;
  // Of ruled colours: the ways in which all intensities together may still change, lights × RGB.
  std::vector<Eigen::MatrixX3d> directions{};
};

// Least squares, intensities ≥ 0, over all channels.
IntensityFit fit_intensities(const std::array<WeightedSystem, 3>& channels, const IntensityRules& rules);
IntensityFit fit_intensities(const std::array<NormalEquations, 3>& channels, const IntensityRules& rules);

}  // namespace chiaro::inverse

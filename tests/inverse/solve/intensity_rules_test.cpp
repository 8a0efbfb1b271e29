#include "inverse/solve/intensity_rules.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/blackbody.h"
#include "renderer/core/sampler.h"

namespace chiaro::inverse {
namespace {

constexpr Eigen::Index kReceivers = 40;

// Random columns of so many lights, the same in all channels, and what they bring at these intensities.
std::array<WeightedSystem, 3> systems_of(const Eigen::MatrixX3d& intensity) {
  Eigen::MatrixXd a(kReceivers, intensity.rows());
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    a.data()[i] = double(renderer::Sampler(3, 0, std::uint32_t(i)).next_1d());
  }
  std::array<WeightedSystem, 3> systems;
  for (Eigen::Index c = 0; c < 3; ++c) systems[std::size_t(c)] = {a, a * intensity.col(c)};
  return systems;
}

double squared_error(const std::array<WeightedSystem, 3>& systems, const Eigen::MatrixX3d& intensity) {
  double error = 0;
  for (Eigen::Index c = 0; c < 3; ++c) {
    const WeightedSystem& system = systems[std::size_t(c)];
    error += (system.a * intensity.col(c) - system.b).squaredNorm();
  }
  return error;
}

double squared_error(const std::array<WeightedSystem, 3>& systems, const IntensityFit& fit) {
  Eigen::MatrixX3d intensity(Eigen::Index(fit.intensity.size()), 3);
  for (std::size_t j = 0; j < fit.intensity.size(); ++j) {
    intensity.row(Eigen::Index(j)) = fit.intensity[j].matrix().transpose();
  }
  return squared_error(systems, intensity);
}

// What one colour is no constraint for: it is that of the limit alone, each channel by itself.
TEST(IntensityRules, OneLightOfAnyColorIsAsNearAsItsLimitAllows) {
  const auto systems = systems_of(Eigen::RowVector3d{100, 60, 25});
  IntensityRules rules;
  rules.max_intensity = 70;
  const double without = squared_error(systems, fit_intensities(systems, rules));
  rules.one_color = true;
  const IntensityFit fit = fit_intensities(systems, rules);
  EXPECT_LT(squared_error(systems, fit), without * (1 + 1e-6));
  EXPECT_NEAR(fit.intensity[0][0], 70, 1e-3);
  EXPECT_NEAR(fit.intensity[0][1], 60, 1e-3);
  EXPECT_NEAR(fit.intensity[0][2], 25, 1e-3);
}

// Against all temperatures of a fine scale, each with its best strength.
TEST(IntensityRules, ALimitedLightHasTheTemperatureThatFitsWithinTheLimit) {
  const auto systems = systems_of(Eigen::RowVector3d{100, 60, 25});
  for (const double limit : {10.0, 70.0, 200.0}) {
    const IntensityRules rules{.max_intensity = limit, .kelvin = {{2000, 10000}}};
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= 800; ++k) {
      const Eigen::RowVector3d color = to_eigen(renderer::blackbody_color(2000 + 10 * k)).transpose();
      for (int s = 1; s <= 400; ++s) least = std::min(least, squared_error(systems, limit * s / 400 * color));
    }
    EXPECT_LT(squared_error(systems, fit_intensities(systems, rules)), 1.0001 * least) << limit;
  }
}

// A wider permission is never worse than a narrower one that lies within it.
TEST(IntensityRules, MayBeWiderWithoutHarm) {
  Eigen::MatrixX3d wanted(3, 3);
  wanted << 100, 60, 25, 20, 30, 60, 40, 40, 10;
  const auto systems = systems_of(wanted);
  for (const bool one_color : {false, true}) {
    for (const double limit : {15.0, 50.0, 1000.0}) {
      IntensityRules rules{.max_intensity = limit, .one_color = one_color, .kelvin = {{2000, 10000}}};
      const double wide = squared_error(systems, fit_intensities(systems, rules));
      for (const double kelvin : {2000.0, 3000.0, 4000.0, 6500.0, 10000.0}) {
        rules.kelvin = {{kelvin, kelvin}};
        const double narrow = squared_error(systems, fit_intensities(systems, rules));
        EXPECT_LT(wide, 1.001 * narrow) << limit << " cd, " << kelvin << " K, one colour: " << one_color;
      }
    }
  }
}

}  // namespace
}  // namespace chiaro::inverse

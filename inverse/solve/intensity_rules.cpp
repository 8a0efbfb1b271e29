// Where colours are ruled, intensities are strengths times colours, and both are fitted in turns.
//
//   l_jc = s_j k_jc,  max_c k_jc = 1;  cost = Σ_c ½ lᵀ G_c l − b_cᵀ l

#include "inverse/solve/intensity_rules.h"

#include <algorithm>
#include <cmath>

#include "inverse/numerics/bounded_least_squares.h"
#include "inverse/numerics/working_set_nnls.h"
#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/blackbody.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

using Systems = std::array<WeightedSystem, 3>;
using Eigen::Index;
using Eigen::MatrixX3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kTurns = 60;
constexpr double kSettled = 1e-9;  // relative change of the cost
constexpr int kTemperatures = 12;  // tried over the range, before the best is refined …
constexpr int kHalvings = 40;      // … by golden sections
constexpr double kMired = 0.5;     // for the derivative of a colour

// Intensities are given out as floats, and must not be above the limit then.
double largest_float_up_to(double limit) {
  const auto rounded = float(limit);
  return double(double(rounded) > limit ? std::nextafter(rounded, 0.0F) : rounded);
}

using Channels = std::array<NormalEquations, 3>;

Channels normal_equations(const Systems& systems) {
  Channels channels;
  for (std::size_t c = 0; c < 3; ++c) {
    const Eigen::MatrixXd& a = systems[c].a;
    channels[c] = {Eigen::MatrixXd::Zero(a.cols(), a.cols()), a.transpose() * systems[c].b};
    channels[c].gram.selfadjointView<Eigen::Lower>().rankUpdate(a.transpose());
    channels[c].gram.triangularView<Eigen::StrictlyUpper>() = channels[c].gram.transpose();
  }
  return channels;
}

MatrixX3d each_channel_by_itself(const Systems& systems, IntensityFit& fit) {
  std::array<numerics::NnlsResult, 3> results;
  renderer::parallel_for(3,
                         [&](std::size_t c) { results[c] = numerics::working_set_nnls(systems[c].a, systems[c].b); });
  MatrixX3d intensity(systems[0].a.cols(), 3);
  for (Index c = 0; c < 3; ++c) {
    intensity.col(c) = results[std::size_t(c)].x;
    fit.kkt_residual = std::max(fit.kkt_residual, results[std::size_t(c)].kkt_residual);
    fit.iterations += results[std::size_t(c)].iterations;
  }
  return intensity;
}

MatrixX3d each_channel_up_to(const Channels& channels, double upper, IntensityFit& fit) {
  MatrixX3d intensity(channels[0].atb.size(), 3);
  for (Index c = 0; c < 3; ++c) {
    const NormalEquations& channel = channels[std::size_t(c)];
    const auto r =
        numerics::bounded_least_squares(channel.gram, channel.atb, VectorXd::Constant(channel.atb.size(), upper));
    intensity.col(c) = r.x;
    fit.kkt_residual = std::max(fit.kkt_residual, r.kkt_residual);
    fit.iterations += r.iterations;
  }
  return intensity;
}

std::vector<Eigen::Array3d> rows_of(const MatrixX3d& intensity) {
  std::vector<Eigen::Array3d> rows;
  for (Index j = 0; j < intensity.rows(); ++j) rows.emplace_back(intensity.row(j).transpose().array());
  return rows;
}

double cost_of(const Channels& channels, const MatrixX3d& intensity) {
  double cost = 0;
  for (int c = 0; c < 3; ++c) {
    const VectorXd l = intensity.col(c);
    cost += 0.5 * l.dot(channels[std::size_t(c)].gram * l) - l.dot(channels[std::size_t(c)].atb);
  }
  return cost;
}

Vector3d color_at(double mired) { return to_eigen(renderer::blackbody_color(1e6 / mired)); }

// Of the range, as far as this function's least value is found.
template <class Cost>
double best_mired(const std::array<double, 2>& kelvin, const Cost& cost) {
  const double low = 1e6 / kelvin[1], high = 1e6 / kelvin[0], step = (high - low) / kTemperatures;
  double best = low;
  for (int k = 1; k <= kTemperatures; ++k) {
    if (cost(low + k * step) < cost(best)) best = low + k * step;
  }
  double a = std::max(low, best - step), b = std::min(high, best + step);
  constexpr double kGolden = 0.6180339887498949;
  for (int k = 0; k < kHalvings && b - a > 1e-3; ++k) {
    const double x = b - kGolden * (b - a), y = a + kGolden * (b - a);
    (cost(x) < cost(y) ? b : a) = cost(x) < cost(y) ? y : x;
  }
  const double middle = (a + b) / 2;
  return cost(middle) < cost(best) ? middle : best;
}

class RuledColors {
 public:
  RuledColors(Channels channels, const IntensityRules& rules)
      : channels_(std::move(channels)),
        rules_(rules),
        upper_(largest_float_up_to(rules.max_intensity)),
        count_(channels_[0].atb.size()),
        strength_(VectorXd::Zero(count_)),
        color_(MatrixX3d::Ones(count_, 3)),
        mired_(VectorXd::Zero(count_)) {}

  IntensityFit fit() {
    IntensityFit result;
    start_from(each_channel_up_to(channels_, std::numeric_limits<double>::infinity(), result));
    double cost = std::numeric_limits<double>::infinity();
    for (int turn = 0; turn < kTurns; ++turn) {
      fit_strengths();
      const double now = cost_of(channels_, intensity());
      if (!(now < cost - kSettled * std::abs(now))) break;
      cost = now;
      fit_colors();
    }
    const numerics::BoundedLeastSquares last = fit_strengths();
    result.kkt_residual = last.kkt_residual;
    result.iterations += last.iterations;
    result.directions = directions();
    result.intensity = rows_of(intensity());
    return result;
  }

 private:
  MatrixX3d intensity() const { return strength_.asDiagonal() * color_; }

  void start_from(const MatrixX3d& free) {
    const auto distance_to = [](const Vector3d& intensity, double limit) {
      return AlongColor{intensity, Vector3d::Ones(), limit};
    };
    if (rules_.one_color) return set_one_color(distance_to(free.colwise().sum(), double(count_) * upper_));
    for (Index j = 0; j < count_; ++j) set_temperature(j, distance_to(free.row(j), upper_));
  }

  // What a colour's cost is ½ s² Σ k² squared − s Σ k along of, with the best strength s from 0 to the limit.
  struct AlongColor {
    Vector3d along, squared;
    double limit;

    double strength(const Vector3d& color) const {
      return std::clamp(color.dot(along) / std::max(color.cwiseAbs2().dot(squared), 1e-300), 0.0, limit);
    }
    double cost(const Vector3d& color) const {
      const double s = strength(color);
      return s * s * color.cwiseAbs2().dot(squared) / 2 - s * color.dot(along);
    }
    // The best of all colours, times its strength.
    Vector3d best() const { return along.cwiseQuotient(squared.cwiseMax(1e-300)).cwiseMax(0).cwiseMin(limit); }
  };

  // None that costs more than the one that it has.
  void set_temperature(Index light, const AlongColor& along) {
    const auto cost = [&](double mired) { return along.cost(color_at(mired)); };
    const double best = best_mired(*rules_.kelvin, cost);
    if (mired_[light] > 0 && !(cost(best) < cost(mired_[light]))) return;
    mired_[light] = best;
    color_.row(light) = color_at(best).transpose();
  }

  void set_one_color(const AlongColor& along) {
    const Vector3d best = along.best();
    if (rules_.kelvin) {
      set_temperature(0, along);
    } else if (best.maxCoeff() > 0) {
      color_.row(0) = (best / best.maxCoeff()).transpose();
    }
    for (Index j = 1; j < count_; ++j) color_.row(j) = color_.row(0), mired_[j] = mired_[0];
  }

  numerics::BoundedLeastSquares fit_strengths() {
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(count_, count_);
    VectorXd atb = VectorXd::Zero(count_);
    for (int c = 0; c < 3; ++c) {
      const auto k = color_.col(c).asDiagonal();
      gram += k * channels_[std::size_t(c)].gram * k;
      atb += k * channels_[std::size_t(c)].atb;
    }
    numerics::BoundedLeastSquares fit = numerics::bounded_least_squares(gram, atb, VectorXd::Constant(count_, upper_));
    strength_ = fit.x;
    return fit;
  }

  void fit_colors() {
    if (rules_.one_color) return fit_one_color();
    for (Index j = 0; j < count_; ++j) {
      if (strength_[j] > 0) fit_temperature(j);
    }
  }

  // The strengths being what they are, up to a common factor.
  void fit_one_color() {
    AlongColor all{{}, {}, upper_ / std::max(strength_.maxCoeff(), 1e-300)};
    for (int c = 0; c < 3; ++c) {
      all.along[c] = strength_.dot(channels_[std::size_t(c)].atb);
      all.squared[c] = strength_.dot(channels_[std::size_t(c)].gram * strength_);
    }
    set_one_color(all);
  }

  // With the light's strength, all others being what they are.
  void fit_temperature(Index light) {
    const MatrixX3d all = intensity();
    AlongColor own{{}, {}, upper_};
    for (int c = 0; c < 3; ++c) {
      const NormalEquations& channel = channels_[std::size_t(c)];
      own.squared[c] = channel.gram(light, light);
      own.along[c] = channel.atb[light] - channel.gram.row(light).dot(all.col(c)) + own.squared[c] * all(light, c);
    }
    set_temperature(light, own);
    strength_[light] = own.strength(color_.row(light));
  }

  bool temperature_is_free(Index light) const {
    return mired_[light] - kMired > 1e6 / (*rules_.kelvin)[1] && mired_[light] + kMired < 1e6 / (*rules_.kelvin)[0];
  }

  Eigen::RowVector3d by_mired(Index light) const {
    return strength_[light] * (color_at(mired_[light] + kMired) - color_at(mired_[light] - kMired)).transpose() /
           (2 * kMired);
  }

  std::vector<MatrixX3d> directions() const {
    std::vector<MatrixX3d> ways;
    const auto add = [&](Index light, const Eigen::RowVector3d& change) {
      ways.emplace_back(MatrixX3d::Zero(count_, 3)).row(light) = change;
    };
    for (Index j = 0; j < count_; ++j) {
      if (strength_[j] > 0 && strength_[j] < upper_) add(j, color_.row(j));
      const bool warmer = rules_.kelvin && !rules_.one_color && strength_[j] > 0 && temperature_is_free(j);
      if (warmer) add(j, by_mired(j));
    }
    if (!rules_.one_color) return ways;
    if (rules_.kelvin && temperature_is_free(0)) {
      MatrixX3d& all = ways.emplace_back(MatrixX3d::Zero(count_, 3));
      for (Index j = 0; j < count_; ++j) all.row(j) = by_mired(j);
    }
    for (int c = 0; c < 3 && !rules_.kelvin; ++c) {
      const bool may_grow = strength_.maxCoeff() * color_(0, c) < upper_;
      if (may_grow) ways.emplace_back(MatrixX3d::Zero(count_, 3)).col(c) = strength_;
    }
    return ways;
  }

  Channels channels_;
  const IntensityRules& rules_;
  double upper_;
  Index count_;
  VectorXd strength_;  // candela
  MatrixX3d color_;
  VectorXd mired_;
};

}  // namespace

IntensityFit fit_intensities(const Systems& systems, const IntensityRules& rules) {
  if (systems[0].a.cols() == 0) return {};
  if (rules.any()) return fit_intensities(normal_equations(systems), rules);
  IntensityFit fit;
  fit.intensity = rows_of(each_channel_by_itself(systems, fit));
  return fit;
}

IntensityFit fit_intensities(const Channels& channels, const IntensityRules& rules) {
  if (rules.color_is_ruled()) return RuledColors(channels, rules).fit();
  IntensityFit fit;
  fit.intensity = rows_of(each_channel_up_to(channels, largest_float_up_to(rules.max_intensity), fit));
  return fit;
}

}  // namespace chiaro::inverse

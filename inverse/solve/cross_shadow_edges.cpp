#include "inverse/solve/cross_shadow_edges.h"

#include <algorithm>
#include <cmath>

#include "inverse/transport/direct_light.h"
#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/control.h"
#include "renderer/core/sampler.h"

namespace chiaro::inverse {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kBrightest = 1000;  // receivers of a light whose shadows are looked at
constexpr double kWrong = 0.5;     // of a receiver's direct light, or more: it seems to be lit, or hidden, wrongly
constexpr double kForeign = 2;     // times its direct light: residuals beyond are of something else
constexpr double kWorthIt = 0.01;  // of the squared error: of receivers that seem wrong, and what a move takes off
constexpr double kFarthest = 2e-3, kNearest = 1.5e-4;  // of the region's diagonal, to all sides …
constexpr double kCloser = 0.6;                        // … in turn …
constexpr std::size_t kPlaces = 64;                    // … so many places each

// What the squared error of all receivers becomes as one light moves a little: shadow rays tell it of the receivers
// that are brightest without shadows, and derivatives of all others. Of residuals that no light and no shadow of this
// one explains little counts (Geman, McClure, 1985).
class MovingLight {
 public:
  // residual: of all lights, weighted nowhere.
  MovingLight(const renderer::RayTracer& tracer, const SettlingBench& bench, const LightEstimate& light,
              const Column& residual)
      : tracer_(tracer),
        bench_(bench),
        light_(light),
        residual_(residual),
        unoccluded_(bench.response.unoccluded(light.position)),
        direct_(bench.response.evaluate_with_gradient(light.position, Evaluation::kTracedVisibility)) {
    choose_brightest();
  }

  // Before squared_error_at().
  void sum_up_others() {
    const Vector3d intensity = light_.intensity.matrix();
    for (const std::size_t i : others_) {
      const Vector3d left = residual_.row(row(i)).transpose();
      const double counts = weight(i) / std::pow(1 + left.squaredNorm() / squared_scale(i), 2);
      const Vector3d by_move(direct_.gradient[0](row(i), 0), direct_.gradient[1](row(i), 0),
                             direct_.gradient[2](row(i), 0));
      gradient_ += counts * left.dot(intensity) * by_move;
      hessian_ += counts * intensity.squaredNorm() * by_move * by_move.transpose();
    }
  }

  // Squared error of receivers that seem to be lit, or hidden, and should not be.
  double seemingly_wrong() const {
    double sum = 0;
    for (const std::size_t i : brightest_) {
      const Vector3d whole = unoccluded_[row(i)] * light_.intensity.matrix(), left = residual_.row(row(i)).transpose();
      const double part = left.dot(whole) / whole.squaredNorm();
      const bool lit = direct_light(i) > 0.5 * unoccluded_[row(i)];
      const bool wrong = lit ? part > kWrong : part < -kWrong;
      if (wrong && left.norm() < kForeign * whole.norm()) sum += weight(i) * left.squaredNorm();
    }
    return sum;
  }

  // But for a constant.
  double squared_error_at(const Vector3d& position) const {
    const Vector3d move = position - light_.position;
    double sum = 2 * gradient_.dot(move) + move.dot(hessian_ * move);
    for (const std::size_t i : brightest_) {
      const renderer::SurfaceSample& at = bench_.response.receivers()[i];
      const Vec3f there = to_vec3f(position);
      const double visible = double(visible_part(tracer_, at, there));
      const double change = visible * double(unoccluded_illumination(at, there)) - direct_light(i);
      const Vector3d left = residual_.row(row(i)).transpose() + change * light_.intensity.matrix();
      sum += weight(i) * left.squaredNorm() / (1 + left.squaredNorm() / squared_scale(i));
    }
    return sum;
  }

 private:
  static Eigen::Index row(std::size_t i) { return Eigen::Index(i); }
  double weight(std::size_t i) const { return std::pow(bench_.observations.sqrt_weight[row(i)], 2); }
  double direct_light(std::size_t i) const { return direct_.value(row(i), 0); }
  double squared_scale(std::size_t i) const {
    return std::pow(kForeign * unoccluded_[row(i)], 2) * light_.intensity.matrix().squaredNorm();
  }

  void choose_brightest() {
    for (std::size_t i = 0; i < bench_.response.receiver_count(); ++i) {
      if (weight(i) * unoccluded_[row(i)] > 0) brightest_.push_back(i);
    }
    const std::size_t count = std::min(kBrightest, brightest_.size());
    const auto brighter = [&](std::size_t a, std::size_t b) {
      return weight(a) * std::pow(unoccluded_[row(a)], 2) > weight(b) * std::pow(unoccluded_[row(b)], 2);
    };
    std::nth_element(brightest_.begin(), brightest_.begin() + std::ptrdiff_t(count), brightest_.end(), brighter);
    others_.assign(brightest_.begin() + std::ptrdiff_t(count), brightest_.end());
    brightest_.resize(count);
  }

  const renderer::RayTracer& tracer_;
  const SettlingBench& bench_;
  const LightEstimate& light_;
  const Column& residual_;
  Eigen::VectorXd unoccluded_;
  ColumnWithGradient direct_;  // grey
  std::vector<std::size_t> brightest_, others_;
  Vector3d gradient_ = Vector3d::Zero();
  Eigen::Matrix3d hessian_ = Eigen::Matrix3d::Zero();
};

// The best of places in ever smaller boxes about the best so far.
Vector3d look_around(const MovingLight& light, const LightResponse& response, const Vector3d& from) {
  const double diagonal = double(response.grid().region.diagonal());
  Vector3d best = from;
  double least = light.squared_error_at(from);
  std::uint32_t box = 0;
  for (double far = kFarthest; far > kNearest; far *= kCloser, ++box) {
    const Vec3f center = to_vec3f(best), extent = float(far * diagonal) * Vec3f{1, 1, 1};
    std::vector<Vector3d> places(kPlaces, best);
    std::vector<double> error(kPlaces, least);
    renderer::parallel_for(kPlaces, [&](std::size_t k) {
      renderer::Sampler sampler(box, 0, std::uint32_t(k));
      const Vec3f place = random_position({center - extent, center + extent}, sampler);
      const auto allowed = response.places().nearest(to_eigen(place));
      if (!allowed) return;
      places[k] = *allowed;
      error[k] = light.squared_error_at(places[k]);
    });
    const auto k = std::size_t(std::min_element(error.begin(), error.end()) - error.begin());
    if (error[k] < least) best = places[k], least = error[k];
  }
  return best;
}

}  // namespace

bool cross_shadow_edges(const renderer::RayTracer& tracer, const SettlingBench& bench,
                        const std::vector<Column>& indirect, LightEstimates& lights) {
  Column residual = bench.illumination(indirect, lights) - bench.observations.wanted;
  bool any_moved = false;
  for (LightEstimate& light : lights) {
    const double worth_it = kWorthIt * std::pow(bench.norm(residual), 2);
    MovingLight moving(tracer, bench, light, residual);
    if (moving.seemingly_wrong() <= worth_it) continue;
    moving.sum_up_others();
    const Vector3d place = look_around(moving, bench.response, light.position);
    if (moving.squared_error_at(light.position) - moving.squared_error_at(place) <= worth_it) continue;
    const Column change = bench.response.direct(place) - bench.response.direct(light.position);
    residual += change * light.intensity.matrix().asDiagonal();
    light.position = place;
    any_moved = true;
  }
  return any_moved;
}

}  // namespace chiaro::inverse

#include "inverse/transport/interreflection.h"

#include <algorithm>
#include <cmath>

#include "renderer/core/control.h"
#include "renderer/core/cpu_dispatch.h"

namespace chiaro::inverse {
namespace {

constexpr double kErrorBound = 1e-3;  // relative, of what is left
constexpr double kLeastRadius = 0.05, kMostRadius = 0.999;
constexpr double kMostImaginary = 0.95;   // of the spectral radius
constexpr int kBouncesAtOnce = 64;        // until it is asked whether more would add anything
constexpr int kWarmUp = 8, kPowers = 16;  // of K, for its spectral radius

// Of an ellipse with semi-axes a and b.
double focal_distance(double a, double b) { return std::sqrt(a * a - b * b); }

// By how much a step shrinks the error.
double convergence_factor(double real, double imaginary) {
  const double f = focal_distance(real, imaginary);
  return (real + imaginary) / (1 + std::sqrt(1 - f * f));
}

int steps_needed(const Interreflection& k) {
  double slowest = 0;
  for (int c = 0; c < 3; ++c) slowest = std::max(slowest, convergence_factor(k.spectral_radius[c], k.imaginary[c]));
  return int(std::ceil(std::log(kErrorBound / 2) / std::log(slowest)));
}

// Of thousands of bounces the last are too dim.
template <class Lanes>
bool adds_anything(const std::vector<Lanes>& term, const std::vector<Lanes>& sum) {
  for (std::size_t i = 0; i < sum.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      for (int l = 0; l < Lanes::kLanes; ++l) {
        if (sum[i].channel[c][l] + term[i].channel[c][l] != sum[i].channel[c][l]) return true;
      }
    }
  }
  return false;
}

template <class Lanes>
std::vector<Lanes> first_terms(const SparseTransport& one_bounce, const std::vector<Lanes>& direct, int count,
                               const renderer::Control& control) {
  std::vector<Lanes> sum = direct, term = direct, next(direct.size());
  for (int bounce = 1; bounce < count; ++bounce) {
    control.stop_if_requested();
    multiply(one_bounce, term, next);
    std::swap(term, next);
    if (bounce % kBouncesAtOnce == 0 && !adds_anything(term, sum)) break;
    for (std::size_t i = 0; i < sum.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        for (int l = 0; l < Lanes::kLanes; ++l) sum[i].channel[c][l] += term[i].channel[c][l];
      }
    }
  }
  return sum;
}

// α and β of the next step, per channel.
class StepSizes {
 public:
  explicit StepSizes(const Interreflection& k) {
    for (int c = 0; c < 3; ++c) focus_[c] = focal_distance(k.spectral_radius[c], k.imaginary[c]);
  }

  void advance() {
    for (int c = 0; c < 3; ++c) {
      const double before = ratio_[c];
      ratio_[c] = first_ ? focus_[c] : 1 / (2 / focus_[c] - before);
      momentum[c] = first_ ? 0 : float(ratio_[c] * before);
      gain[c] = first_ ? 1 : float(2 * ratio_[c] / focus_[c]);
    }
    first_ = false;
  }

  std::array<float, 3> momentum{}, gain{};  // α, β

 private:
  std::array<double, 3> focus_{}, ratio_{};
  bool first_ = true;
};

// Of some gather points.
template <class Lanes>
struct Points {
  const Lanes *direct, *kx, *x;
  Lanes *d, *next;
  std::size_t count;
};

template <class Lanes>
[[gnu::always_inline]] inline void take_any_step(const StepSizes& sizes, const Points<Lanes>& at) {
  for (std::size_t i = 0; i < at.count; ++i) {
    for (int c = 0; c < 3; ++c) {
      const float momentum = sizes.momentum[c], gain = sizes.gain[c];
      for (int l = 0; l < Lanes::kLanes; ++l) {
        const float residual = at.direct[i].channel[c][l] + at.kx[i].channel[c][l] - at.x[i].channel[c][l];
        const float step = momentum * at.d[i].channel[c][l] + gain * residual;
        at.d[i].channel[c][l] = step;
        at.next[i].channel[c][l] = at.x[i].channel[c][l] + step;
      }
    }
  }
}

CHIARO_DISPATCH void take_step(const StepSizes& sizes, const Points<LightBlock>& at) { take_any_step(sizes, at); }
CHIARO_DISPATCH void take_step(const StepSizes& sizes, const Points<LightQuad>& at) { take_any_step(sizes, at); }
void take_step(const StepSizes& sizes, const Points<OneLight>& at) { take_any_step(sizes, at); }

template <class Lanes>
std::vector<Lanes> all_bounces(const Interreflection& k, const std::vector<Lanes>& direct,
                               const renderer::Control& control) {
  constexpr std::size_t kRows = 256;
  std::vector<Lanes> x = direct, next(direct.size()), d(direct.size());
  StepSizes sizes(k);
  for (int step = steps_needed(k); step > 0; --step) {
    control.stop_if_requested();
    sizes.advance();
    renderer::parallel_for((x.size() + kRows - 1) / kRows, [&](std::size_t chunk) {
      const std::size_t first = chunk * kRows, count = std::min(kRows, x.size() - first);
      std::array<Lanes, kRows> kx;
      multiply_rows(k.one_bounce, first, x, std::span<Lanes>(kx.data(), count));
      take_step(sizes, Points<Lanes>{&direct[first], kx.data(), &x[first], &d[first], &next[first], count});
    });
    std::swap(x, next);
  }
  return x;
}

std::array<double, 3> norms(const std::vector<OneLight>& light) {
  std::array<double, 3> squares{};
  for (const OneLight& at : light) {
    for (int c = 0; c < 3; ++c) squares[c] += double(at.channel[c][0]) * double(at.channel[c][0]);
  }
  for (double& s : squares) s = std::sqrt(s);
  return squares;
}

// By the power method, from light everywhere; how much some powers grow, as corners let single ones swing.
std::array<double, 3> spectral_radius(const SparseTransport& k) {
  std::vector<OneLight> light(k.row_count()), next(k.row_count());
  for (OneLight& at : light) {
    for (auto& channel : at.channel) channel[0] = 1;
  }
  std::array<double, 3> growth{};  // its logarithm
  for (int power = 0; power < kWarmUp + kPowers; ++power) {
    const auto before = norms(light);
    multiply(k, light, next);
    std::swap(light, next);
    const auto after = norms(light);
    for (int c = 0; c < 3; ++c) {
      if (power >= kWarmUp) growth[c] += std::log(after[c] / before[c]) / kPowers;
    }
  }
  std::array<double, 3> radius{};
  for (int c = 0; c < 3; ++c) {
    // Light that is gone altogether leaves NaN or minus infinity.
    radius[c] = growth[c] > std::log(kLeastRadius) ? std::min(std::exp(growth[c]), kMostRadius) : kLeastRadius;
  }
  return radius;
}

// Of each channel: √(Σ K² / rows), which random entries' eigenvalues stay within (the circular law).
std::array<double, 3> spread(const SparseTransport& k) {
  std::array<double, 3> squares{};
  for (std::size_t i = 0; i < k.row_count(); ++i) {
    for (const SparseTransport::Entry& entry : k.row(i)) {
      for (int c = 0; c < 3; ++c) squares[c] += double(entry.weight[c]) * double(entry.weight[c]);
    }
  }
  for (double& s : squares) s = std::sqrt(s / double(k.row_count()));
  return squares;
}

}  // namespace

Interreflection make_interreflection(SparseTransport one_bounce) {
  Interreflection k{std::move(one_bounce)};
  k.spectral_radius = spectral_radius(k.one_bounce);
  k.imaginary = spread(k.one_bounce);
  for (int c = 0; c < 3; ++c) k.imaginary[c] = std::min(k.imaginary[c], kMostImaginary * k.spectral_radius[c]);
  return k;
}

Interreflection transposed(const Interreflection& k) {
  return {k.one_bounce.transposed(k.one_bounce.row_count()), k.spectral_radius, k.imaginary};
}

template <class Lanes>
std::vector<Lanes> sum_of_bounces(const Interreflection& k, const std::vector<Lanes>& direct, int bounces,
                                  const renderer::Control& control) {
  return bounces < 0 ? all_bounces(k, direct, control) : first_terms(k.one_bounce, direct, bounces, control);
}

template std::vector<LightBlock> sum_of_bounces(const Interreflection&, const std::vector<LightBlock>&, int,
                                                const renderer::Control&);
template std::vector<LightQuad> sum_of_bounces(const Interreflection&, const std::vector<LightQuad>&, int,
                                               const renderer::Control&);
template std::vector<OneLight> sum_of_bounces(const Interreflection&, const std::vector<OneLight>&, int,
                                              const renderer::Control&);

}  // namespace chiaro::inverse

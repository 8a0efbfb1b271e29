// Weighted random sampling without replacement.
// Source: P. S. Efraimidis, P. G. Spirakis, Weighted random sampling with a reservoir, Information Processing Letters
// 97, 2006, algorithm A: the largest keys u^(1/w). The logarithm of minus its logarithm, ln(−ln u) − ln w, has the
// reverse order and neither over- nor underflows. Uniform numbers by the finaliser of G. Steele, D. Lea, C. Flood, Fast
// Splittable Pseudorandom Number Generators, 2014.

#include "inverse/numerics/weighted_sampling.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace chiaro::inverse::numerics {
namespace {

struct Entry {
  bool weightless = false;
  double key = 0;
  std::size_t index = 0;
  auto operator<=>(const Entry&) const = default;
};

std::uint64_t mix(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

// In the open interval (0, 1): 52 bits and a half, so that neither end can be rounded to.
double uniform(std::uint64_t seed, std::uint64_t index) {
  return (double(mix(mix(seed) + index) >> 12) + 0.5) * 0x1p-52;
}

Entry make_entry(double weight, std::size_t index, std::uint64_t seed) {
  const double exponential = -std::log(uniform(seed, index));
  const bool weightless = weight == 0;
  return {weightless, std::log(exponential) - (weightless ? 0 : std::log(weight)), index};
}

}  // namespace

std::vector<std::size_t> sample_without_replacement(std::span<const double> weights, std::size_t count,
                                                    std::uint64_t seed) {
  std::vector<Entry> entries;
  entries.reserve(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (!(weights[i] >= 0 && std::isfinite(weights[i]))) {
      throw std::invalid_argument("sample_without_replacement: a weight is negative or not finite");
    }
    entries.push_back(make_entry(weights[i], i, seed));
  }
  count = std::min(count, entries.size());
  if (count < entries.size()) std::nth_element(entries.begin(), entries.begin() + std::ptrdiff_t(count), entries.end());
  std::vector<std::size_t> chosen(count);
  std::transform(entries.begin(), entries.begin() + std::ptrdiff_t(count), chosen.begin(),
                 [](const Entry& entry) { return entry.index; });
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

std::vector<double> inclusion_probabilities(std::span<const double> weights, std::size_t count) {
  const double largest = weights.empty() ? 0 : *std::max_element(weights.begin(), weights.end());
  const auto positive = std::size_t(std::count_if(weights.begin(), weights.end(), [](double w) { return w > 0; }));
  std::vector<double> probability(weights.size());
  if (positive <= count) {
    std::transform(weights.begin(), weights.end(), probability.begin(), [](double w) { return w > 0 ? 1.0 : 0.0; });
    return probability;
  }
  const auto fill = [&](double tau) {
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) sum += probability[i] = -std::expm1(-tau * (weights[i] / largest));
    return sum;
  };
  double low = 0, high = 1;
  while (fill(high) < double(count) && high < 1e300) high *= 2;
  for (int i = 0; i < 200 && high - low > 1e-12 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (fill(middle) < double(count) ? low : high) = middle;
  }
  fill(high);
  return probability;
}

}  // namespace chiaro::inverse::numerics

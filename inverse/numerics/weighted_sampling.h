#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace chiaro::inverse::numerics {

// `count` distinct indices drawn without replacement with probabilities proportional to weights (≥ 0, finite; those of
// weight 0 only when no others are left, never if `count` can be met without them), ascending. A function of the
// arguments alone. Source: Efraimidis & Spirakis, Weighted random sampling with a reservoir, 2006 (the largest of
// u^(1/w)).
std::vector<std::size_t> sample_without_replacement(std::span<const double> weights, std::size_t count,
                                                    std::uint64_t seed);

// With which probability each index is among the `count` drawn: 1 − exp(−w τ), τ such that they add up to `count`. The
// probabilities of the draw above in the limit of many indices. For the weighted estimate of a sum over all from a sum
// over those drawn: Horvitz & Thompson, A generalization of sampling without replacement from a finite universe, 1952.
std::vector<double> inclusion_probabilities(std::span<const double> weights, std::size_t count);

}  // namespace chiaro::inverse::numerics

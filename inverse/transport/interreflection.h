#pragma once
// Light over all its bounces between surface points, D + K D + K² D + … = (I − K)⁻¹ D, by Chebyshev's semi-iteration:
//
//   r = D + K x − x,   d ← α d + β r,   x ← x + d
//
// Of all ways to choose α and β beforehand it shrinks the error fastest where the eigenvalues of K lie within an ellipse
// about 0 of semi-axes λ, along the real numbers, and μ: each step to (λ + μ) / (1 + √(1 − λ² + μ²)) where a bounce
// alone leaves λ. Surfaces that nearly touch make some of them negative. Source: Golub, Varga, Chebyshev Semi-Iterative
// Methods, Successive Overrelaxation Iterative Methods, and Second Order Richardson Iterative Methods, 1961.

#include <array>
#include <vector>

#include "inverse/transport/sparse_transport.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {

struct Interreflection {
  SparseTransport one_bounce;               // K
  std::array<double, 3> spectral_radius{};  // λ, per channel
  std::array<double, 3> imaginary{};        // μ: as far as so much chance spreads eigenvalues (circular law)
};

// K has as many columns as rows.
Interreflection make_interreflection(SparseTransport one_bounce);

// The adjoint: Kᵀ in place of K.
Interreflection transposed(const Interreflection& interreflection);

// `bounces` terms of the series, direct light the first of them; −1: all, to 1e-3 (relative L2), mostly far less.
// Lanes: LightBlock, LightQuad or OneLight. control: to be interrupted, as bright rooms take thousands of steps.
template <class Lanes>
std::vector<Lanes> sum_of_bounces(const Interreflection& interreflection, const std::vector<Lanes>& direct, int bounces,
                                  const renderer::Control& control = {});

}  // namespace chiaro::inverse

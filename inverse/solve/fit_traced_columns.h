#pragma once

#include "inverse/solve/observations.h"

namespace chiaro::inverse {

// Of a direction's AᵀA, the part that is no noise at least: of less nothing is known.
inline constexpr double kLeastSure = 0.1;

// As fit_intensities(), of columns that are path traced: their noise adds its square to AᵀA, so that least squares
// would dim the lights. again: another trace A′ of the same columns, by other paths and as many or fewer; that noise
// being another, A′ᵀA has none of it. Source: Fuller, Measurement Error Models, 1987 (instrumental variables,
// replicated measurements).
IntensityFit fit_traced_columns(const Observations& observations, const std::vector<Column>& columns,
                                const std::vector<Column>& again);

}  // namespace chiaro::inverse

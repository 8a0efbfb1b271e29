#pragma once
// Where a frame needs more samples: passes, and the stopping rule of --noise-threshold.
//
// The error of a tile is the standard error of its pixels over its mean,
//   error = sqrt(mean over pixels and R, G, B of the variance of the pixel's mean) / max(mean value, floor),
// floor: kFloor times the median of the lit tiles' means, so that dark corners get what an eye adapted to the frame can
// see. A tile is done where error <= threshold, for itself and for the 3 × 3 tiles around it together.
//
// A rule that looks at the samples it stops is biased: a pixel stops early where its samples happen to be dark and
// alike. Here either half of the frame goes by the other's samples (after the dual buffers of Rousselle, Knaus,
// Zwicker, Adaptive Rendering with Non-Local Means Filtering, 2012), and both count the same in the mean. What is left
// of the bias is light that so few samples bring that a tile's first ones (64 pixels × 16) have none of it: where
// neither half has met it both stop, and a half that stopped goes on when the other meets it after all. Of light that
// comes once in 1000 samples a third may be lost, of light that comes once in 50 nothing.

#include <array>
#include <vector>

#include "renderer/trace/film.h"

namespace chiaro::renderer {

// After `asked` samples per batch the next pass goes on to so many: 1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20 …
int next_batch_samples(int asked);

// No tile stops before each batch has so many samples.
inline constexpr int kLeastBatchSamples = 4;

// What each half of each tile is asked for in the next pass, samples per batch; as before: it has all it needs.
// noise_threshold 0: every half goes on until it has `samples` per pixel.
using PassPlan = std::vector<std::array<int, 2>>;
PassPlan plan_pass(const Film& film, double noise_threshold);

// Samples of all pixels that the pass takes.
double cost_of(const Film& film, const PassPlan& plan);

}  // namespace chiaro::renderer

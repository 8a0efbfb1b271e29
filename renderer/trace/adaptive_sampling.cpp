#include "renderer/trace/adaptive_sampling.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace chiaro::renderer {
namespace {

constexpr double kFloor = 0.1;

bool is_full(const Film& film, int half, int asked) {
  return film.batch_samples(half, asked + 1) == film.batch_samples(half, asked) &&
         film.batch_samples(half + 2, asked + 1) == film.batch_samples(half + 2, asked);
}

// Of one half, all tiles.
std::vector<HalfStatistics> statistics_of(const Film& film, int half) {
  std::vector<HalfStatistics> all(film.tile_count());
  for (std::size_t tile = 0; tile < all.size(); ++tile) all[tile] = film.statistics(tile, half);
  return all;
}

double floor_of(const std::vector<HalfStatistics>& tiles) {
  std::vector<double> lit;
  for (const HalfStatistics& s : tiles) {
    if (s.value > 0) lit.push_back(s.value);
  }
  if (lit.empty()) return 0;
  std::nth_element(lit.begin(), lit.begin() + std::ptrdiff_t(lit.size() / 2), lit.end());
  return kFloor * lit[lit.size() / 2];
}

// Mean over the 3 × 3 tiles around one, as far as there are any.
HalfStatistics around(const std::vector<HalfStatistics>& tiles, std::size_t tile, int columns) {
  const int rows = int(tiles.size()) / columns, x = int(tile) % columns, y = int(tile) / columns;
  HalfStatistics mean;
  int count = 0;
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, rows - 1); ++j) {
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, columns - 1); ++i, ++count) {
      const HalfStatistics& s = tiles[std::size_t(j) * columns + i];
      mean.value += s.value;
      mean.variance += s.variance;
    }
  }
  return {mean.value / count, mean.variance / count};
}

// Variance of the mean of two halves of `samples` each, against the square of what is allowed.
bool is_noisy(const HalfStatistics& s, int samples, double threshold, double floor) {
  const double allowed = threshold * std::max(s.value, floor);
  return s.variance / (2.0 * samples) > allowed * allowed;
}

}  // namespace

int next_batch_samples(int asked) { return asked < 4 ? asked + 1 : asked + int(std::bit_floor(unsigned(asked))) / 4; }

PassPlan plan_pass(const Film& film, double noise_threshold) {
  PassPlan plan(film.tile_count());
  for (std::size_t tile = 0; tile < plan.size(); ++tile) plan[tile] = film.asked(tile);
  for (int half = 0; half < 2; ++half) {
    std::vector<HalfStatistics> other;
    double floor = 0;
    for (std::size_t tile = 0; tile < plan.size(); ++tile) {
      int& asked = plan[tile][half];
      if (is_full(film, half, asked)) continue;
      if (noise_threshold > 0 && asked >= kLeastBatchSamples) {
        if (other.empty()) {
          other = statistics_of(film, 1 - half);
          floor = floor_of(other);
        }
        const auto noisy = [&](const HalfStatistics& s) { return is_noisy(s, 2 * asked, noise_threshold, floor); };
        if (!noisy(other[tile]) && !noisy(around(other, tile, film.tile_columns()))) continue;
      }
      asked = next_batch_samples(asked);
    }
  }
  return plan;
}

double cost_of(const Film& film, const PassPlan& plan) {
  double cost = 0;
  for (std::size_t tile = 0; tile < plan.size(); ++tile) {
    for (int batch = 0; batch < kBatches; ++batch) {
      const int before = film.batch_samples(batch, film.asked(tile)[batch & 1]);
      cost += double(film.tile(tile).pixels()) * (film.batch_samples(batch, plan[tile][batch & 1]) - before);
    }
  }
  return cost;
}

}  // namespace chiaro::renderer

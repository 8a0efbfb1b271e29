// Statistical bounds: fixed seeds, five standard errors (p < 0.0001 %).

#include "renderer/trace/adaptive_sampling.h"

#include <gtest/gtest.h>

namespace chiaro::renderer {
namespace {

// Runs the plan to its end with samples of its own making: value(tile, sampler).
template <class Value>
void run(Film& film, double threshold, std::uint64_t seed, const Value& value) {
  for (;;) {
    const PassPlan plan = plan_pass(film, threshold);
    if (cost_of(film, plan) == 0) return;
    for (std::size_t tile = 0; tile < plan.size(); ++tile) {
      TileSums sums = film.make_sums(tile);
      for (int pixel = 0; pixel < film.tile(tile).pixels(); ++pixel) {
        for (int batch = 0; batch < kBatches; ++batch) {
          const int first = film.batch_samples(batch, film.asked(tile)[batch & 1]);
          const int last = film.batch_samples(batch, plan[tile][batch & 1]);
          for (int i = first; i < last; ++i) {
            Sampler sampler(seed, std::uint32_t(64 * tile + std::size_t(pixel)), std::uint32_t(kBatches * i + batch));
            PixelSample sample;
            const float v = value(tile, unit_float(sampler.next_bits()));
            sample.beauty = {v, v, v};
            film.add(sums, pixel, batch, sample);
          }
        }
      }
      film.merge(tile, sums, plan[tile]);
    }
  }
}

double mean_of(const Image& image) {
  double sum = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += image.channel_names.size()) sum += double(image.pixels[i]);
  return sum / (double(image.width) * image.height);
}

TEST(AdaptiveSampling, BatchesGrowByAnEighthToAQuarter) {
  int asked = 0;
  std::vector<int> steps;
  while (asked < 40) steps.push_back(asked = next_batch_samples(asked));
  EXPECT_EQ(steps, (std::vector<int>{1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40}));
}

TEST(AdaptiveSampling, WithoutThresholdEveryPixelHasTheSamplesAskedFor) {
  for (const int samples : {1, 2, 3, 5, 16, 37}) {
    Film film(20, 11, {}, {}, samples);
    run(film, 0, 1, [](std::size_t, float) { return 1.0F; });
    for (std::size_t tile = 0; tile < film.tile_count(); ++tile) EXPECT_EQ(film.tile_samples(tile), samples);
    Image image = film.blank();
    film.finish(image);
    for (int y = 0; y < 11; ++y) {
      for (int x = 0; x < 20; ++x) EXPECT_FLOAT_EQ(image.at(x, y)[0], 1);
    }
  }
}

TEST(AdaptiveSampling, NoisyTilesGetMoreAndReachTheThreshold) {
  // Uniform on 1 − a … 1 + a: the variance of a sample is a²/3. Quiet and loud columns of tiles.
  constexpr float kLoud = 0.9F, kQuiet = 0.2F;
  constexpr double kThreshold = 0.06;
  const auto amplitude = [](std::size_t tile) { return tile % 16 < 8 ? kLoud : kQuiet; };
  Film film(128, 64, {"variance"}, {}, 1024);
  run(film, kThreshold, 7, [&](std::size_t tile, float u) { return 1 + amplitude(tile) * (2 * u - 1); });
  double loud = 0;
  for (std::size_t tile = 0; tile < film.tile_count(); ++tile) {
    if (tile % 16 == 7 || tile % 16 == 8) continue;  // beside the other kind
    const double needed = double(amplitude(tile) * amplitude(tile)) / 3 / (kThreshold * kThreshold);
    EXPECT_GE(film.tile_samples(tile), std::max(0.6 * needed, 4.0 * kLeastBatchSamples)) << tile;
    EXPECT_LE(film.tile_samples(tile), std::max(2 * needed, 4.0 * kLeastBatchSamples)) << tile;
    loud += film.tile_samples(tile) > 4 * kLeastBatchSamples ? 1 : 0;
  }
  EXPECT_GE(loud, 50);
}

TEST(AdaptiveSampling, StoppingDoesNotBiasTheMean) {
  // One bright sample in fifty: where none is seen all is dark and quiet, and a rule that goes by the samples it stops
  // would leave it so.
  constexpr double kProbability = 0.02;
  const auto spike = [](std::size_t, float u) { return double(u) < kProbability ? 50.0F : 0.25F; };
  constexpr double kMean = kProbability * 50 + (1 - kProbability) * 0.25;
  double sum = 0, variance = 0, samples = 0;
  constexpr int kFrames = 4;
  for (int frame = 0; frame < kFrames; ++frame) {
    Film film(256, 256, {"variance", "samples"}, {}, 512);
    run(film, 0.8, std::uint64_t(frame), spike);
    Image image = film.blank();
    film.finish(image);
    sum += mean_of(image) / kFrames;
    for (std::size_t i = 0; i < image.pixels.size(); i += image.channel_names.size()) {
      variance += double(image.pixels[i + 4]);
      samples += double(image.pixels[i + 7]) / (kFrames * 256 * 256);
    }
  }
  EXPECT_LT(samples, 200);
  EXPECT_GT(samples, 30);
  const double standard_error = std::sqrt(variance) / (kFrames * 256 * 256);
  EXPECT_LT(standard_error, 0.002 * kMean);
  EXPECT_NEAR(sum, kMean, 5 * standard_error);
}

}  // namespace
}  // namespace chiaro::renderer

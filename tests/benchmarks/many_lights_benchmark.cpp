// What many point lights cost over one, on five balls: time × relative mean squared error of a frame. A frame of so
// many lights is compared with the mean of many of the same kind, and with that of one light, averaged over several
// places that it may stand in. The same light altogether, below the ceiling or all over the room. The figures: `error`
// the relative mean squared error, `cost` time × error, `ratio` cost over that of one light.

#include <benchmark/benchmark.h>

#include <ctime>
#include <map>

#include "renderer/core/sampler.h"
#include "renderer/io/load_gltf.h"
#include "renderer/trace/render.h"

namespace chiaro::renderer {
namespace {

constexpr int kSamples = 16, kReferenceSamples = 512, kPlaces = 4;

struct Stage {
  LoadedScene loaded = load_gltf(CHIARO_SOURCE_DIR "/scenes/fiveballs.glb");
  RayTracer tracer{loaded.scene};
};

const Stage& stage() {
  static const Stage only;
  return only;
}

enum Places : std::int64_t { kCeiling, kRoom };

Lights lights(std::size_t count, Places places, std::uint32_t seed) {
  Lights all;
  for (std::uint32_t i = 0; i < count; ++i) {
    Sampler sampler(seed, 0, i);
    const Vec2f xz = sampler.next_2d();
    const float height = places == kCeiling ? 2.2F + 0.5F * sampler.next_1d() : 0.3F + 2.4F * sampler.next_1d();
    const float candela = 100 / float(count);
    all.emplace_back(PointLight{"", {5 * xz.x - 2.5F, height, 5 * xz.y - 2.5F}, {candela, candela, candela}});
  }
  return all;
}

Image frame(const Lights& some, int samples, std::uint64_t seed) {
  RenderOptions options;
  options.width = 160;
  options.height = 90;
  options.trace = {.samples = samples, .seed = seed};
  return render(stage().tracer, stage().loaded.scene.cameras.at(0), some, options).image;
}

double relative_error(const Image& image, const Image& reference) {
  double difference = 0, value = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (i % 4 == 3) continue;  // alpha
    difference += std::pow(double(image.pixels[i]) - double(reference.pixels[i]), 2);
    value += std::pow(double(reference.pixels[i]), 2);
  }
  return difference / value;
}

void many_lights(benchmark::State& state) {
  const auto count = std::size_t(state.range(0));
  const auto places = Places(state.range(1));
  static std::map<std::int64_t, double> cost_of_one;
  double error = 0, seconds = 0;
  int frames = 0;
  for (auto _ : state) {
    const std::uint32_t seed = std::uint32_t(frames % kPlaces);
    const Lights some = lights(count, places, seed);
    state.PauseTiming();
    static std::map<std::tuple<std::size_t, std::int64_t, std::uint32_t>, Image> references;
    Image& reference = references[{count, places, seed}];
    if (reference.pixels.empty()) reference = frame(some, kReferenceSamples, 1000);
    state.ResumeTiming();
    const std::clock_t start = std::clock();
    const Image image = frame(some, kSamples, seed);
    seconds += double(std::clock() - start) / CLOCKS_PER_SEC;
    error += relative_error(image, reference);
    ++frames;
  }
  const double cost = error / frames * seconds / frames;
  if (count == 1) cost_of_one[places] = cost;
  state.counters["error"] = error / frames;
  state.counters["cost"] = cost;
  state.counters["ratio"] = cost / cost_of_one[places];
}

BENCHMARK(many_lights)
    ->ArgNames({"lights", "room"})
    ->ArgsProduct({{1, 8, 100, 1000}, {kCeiling, kRoom}})
    ->Iterations(2 * kPlaces)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace chiaro::renderer

BENCHMARK_MAIN();

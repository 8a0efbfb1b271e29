// How time and memory of a bake grow with receivers and lights.
//   bake_cost_benchmark SCENE.glb [MEMORY_GB]

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "inverse/transport/bake.h"
#include "renderer/core/seconds_since.h"
#include "renderer/io/load_gltf.h"

namespace {

using namespace chiaro;
using namespace chiaro::inverse;

constexpr std::size_t kReceivers[] = {1000, 4000, 16'000, 64'000};
constexpr std::array<int, 3> kGrids[] = {{4, 4, 4}, {8, 8, 8}, {16, 16, 16}, {16, 32, 16}};

// Linux: 5 there makes the peak what is resident now.
void reset_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

double peak_megabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmHWM:", 0) == 0) return std::atof(line.c_str() + 6) / 1024;
  }
  return 0;
}

// At least so many, thinned to so many.
Receivers receivers_of(const renderer::RayTracer& tracer, std::size_t count) {
  Receivers all = make_receivers(tracer.scene(), {});
  for (float edge = tracer.bounds().diagonal() / 50; all.size() < count; edge *= 0.8F) {
    all = make_receivers(tracer.scene(), {.max_edge = edge});
  }
  return select_receivers(all, evenly_spread(all.size(), count));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::puts("bake_cost_benchmark SCENE.glb [MEMORY_GB]");
    return 2;
  }
  const renderer::LoadedScene loaded = renderer::load_gltf(argv[1]);
  const renderer::RayTracer tracer(loaded.scene);
  const double memory = (argc > 2 ? std::atof(argv[2]) : 4) * 1e9;
  const BakeSettings settings{.samples = 256, .bounces = -1, .seed = 0, .materials = "gltf"};
  std::puts("receivers   lights   seconds   direct   indirect   ns per entry   peak MB");
  for (const std::size_t count : kReceivers) {
    const Receivers receivers = receivers_of(tracer, count);
    for (const auto& counts : kGrids) {
      const LightGrid grid = make_light_grid(tracer, {.counts = counts, .region = {}});
      reset_peak();
      const auto start = std::chrono::steady_clock::now();
      Baker baker(tracer, receivers, grid, settings, memory);
      baker.bake(0, receivers.size(), {}, [](const TransportBlock&) {}, {});
      const double seconds = renderer::seconds_since(start);
      const BakeSummary& summary = baker.summary();
      std::printf("%9zu   %6zu   %7.2f   %6.2f   %8.2f   %12.1f   %7.0f\n", receivers.size(), grid.positions.size(),
                  seconds, summary.direct_seconds, summary.indirect_seconds,
                  1e9 * seconds / double(receivers.size() * grid.positions.size()), peak_megabytes());
      std::fflush(stdout);
    }
  }
  return 0;
}

// How far the interpolated response to a light off the grid is from the exact one, and by whole columns as published;
// and how long the exact one takes.
//   interpolation_benchmark SCENE.glb [X,Y,Z|E% [POSITIONS [RECEIVERS]]]

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "inverse/transport/bake.h"
#include "inverse/transport/grid_by_error.h"
#include "inverse/transport/light_response.h"
#include "renderer/core/seconds_since.h"
#include "renderer/io/load_gltf.h"

namespace {

using namespace chiaro;
using namespace chiaro::inverse;
using renderer::seconds_since;

void print_errors(const char* name, std::vector<double> errors) {
  std::sort(errors.begin(), errors.end());
  std::printf("%-34s median %6.2f %%, 95 %% below %6.2f %%\n", name, 100 * errors[errors.size() / 2],
              100 * errors[errors.size() * 95 / 100]);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::puts("interpolation_benchmark SCENE.glb [X,Y,Z|E% [POSITIONS [RECEIVERS]]]");
    return 2;
  }
  const renderer::LoadedScene loaded = renderer::load_gltf(argv[1]);
  const renderer::RayTracer tracer(loaded.scene);
  LightGridOptions grid_options;
  if (argc > 2 && argv[2][std::strlen(argv[2]) - 1] == '%') {
    grid_options.error = std::atof(argv[2]) / 100;
  } else if (argc > 2) {
    std::sscanf(argv[2], "%d,%d,%d", &grid_options.counts[0], &grid_options.counts[1], &grid_options.counts[2]);
  }
  const std::size_t count = argc > 3 ? std::size_t(std::atoi(argv[3])) : 1000;
  const Receivers all = make_receivers(loaded.scene, {});
  const Receivers receivers =
      select_receivers(all, evenly_spread(all.size(), argc > 4 ? std::size_t(std::atoi(argv[4])) : 1000));
  const BakeSettings settings{.samples = 256, .bounces = -1, .seed = 0, .materials = "gltf"};
  const auto start_of_grid = std::chrono::steady_clock::now();
  const LightGrid grid = choose_light_grid(tracer, all, grid_options, settings);
  const double grid_seconds = seconds_since(start_of_grid);
  const TransportCache cache = bake(tracer, receivers, grid, settings).cache;
  const GatherOperator gather =
      make_gather_operator(tracer, receivers.samples, {.samples = 256, .bounces = -1, .seed = 0});
  const LightResponse response(tracer, receivers.samples, cache, &gather);

  std::vector<double> traced, apart, whole;
  double direct_seconds = 0, exact_seconds = 0, gradient_seconds = 0;
  for (const Vec3f position : random_light_positions(tracer, grid.region, count, 1)) {
    const Eigen::Vector3d at(position.x, position.y, position.z);
    auto start = std::chrono::steady_clock::now();
    response.direct(at);
    direct_seconds += seconds_since(start) / double(count);
    start = std::chrono::steady_clock::now();
    const Column exact = response.evaluate(at, Evaluation::kExact);
    exact_seconds += seconds_since(start) / double(count);
    start = std::chrono::steady_clock::now();
    response.evaluate_with_gradient(at, Evaluation::kExact);
    gradient_seconds += seconds_since(start) / double(count);
    traced.push_back((response.evaluate(at, Evaluation::kTracedVisibility) - exact).norm() / exact.norm());
    apart.push_back((response.evaluate(at, Evaluation::kInterpolated) - exact).norm() / exact.norm());
    whole.push_back((response.interpolated_columns(at) - exact).norm() / exact.norm());
  }
  std::printf("%zu lights, %d x %d x %d and %zu in finer cells, chosen in %.1f s; %zu receivers, %zu positions\n",
              grid.positions.size(), grid.counts[0], grid.counts[1], grid.counts[2], grid.finer.size(), grid_seconds,
              receivers.size(), count);
  print_errors("visibility traced", traced);
  print_errors("visibility interpolated, too", apart);
  print_errors("whole columns, as published", whole);
  std::printf("exact: %.2f ms, with its derivatives %.2f ms; direct alone %.2f ms\n", 1e3 * exact_seconds,
              1e3 * gradient_seconds, 1e3 * direct_seconds);
  return 0;
}

// Whether memory and open files stay as they are: many solves in one process, each from the scene's file on, and a long
// render.
//   long_run_benchmark SCENE.glb --solves 200 --render-seconds 600

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>
#include <CLI/CLI.hpp>

#include "inverse/solve/solve.h"
#include "renderer/io/load_gltf.h"
#include "renderer/trace/render.h"
#include "tests/benchmarks/parse_options.h"
#include "tests/benchmarks/random_light_sets.h"

namespace {

using namespace chiaro;
using namespace chiaro::benchmarks;

struct Options {
  std::string scene;
  std::size_t solves = 200, rows = 10;
  double render_seconds = 600;
  float max_edge = 1.5F;
};

Options parse(int argc, char** argv) {
  Options options;
  CLI::App app("Whether memory and open files stay as they are");
  app.add_option("scene", options.scene)->required();
  app.add_option("--solves", options.solves);
  app.add_option("--render-seconds", options.render_seconds);
  app.add_option("--max-edge", options.max_edge, "Of the receivers, metres");
  app.add_option("--rows", options.rows, "Of each table");
  parse_or_exit(app, argc, argv);
  return options;
}

double resident_megabytes() {
  std::size_t program = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> program >> resident;
  return double(resident) * double(::sysconf(_SC_PAGESIZE)) / 1e6;
}

long open_files() {
  const std::filesystem::directory_iterator files("/proc/self/fd");
  return std::distance(begin(files), end(files));
}

void print_row(const char* what, double after) {
  std::printf("%-8s %8.0f %12.1f %11ld\n", what, after, resident_megabytes(), open_files());
  std::fflush(stdout);
}

void solve_once(const Options& options, std::size_t number) {
  const Stage stage(options.scene, options.max_edge);
  const SetNumber set{1, 1 + number % 3, number};
  const inverse::Target target = traced_target(stage, random_lights(stage, set), set, TargetOptions{0.1, {}});
  inverse::SolveOptions solving;
  solving.verification_samples = 4;
  solving.important_vertices = 200;
  inverse::LightGridOptions grid;
  grid.counts = {6, 6, 6};
  inverse::BakeSettings bake;
  bake.samples = 16;
  inverse::solve({stage.tracer, target, {}, grid, bake, {}}, solving);
}

void render_for(const Options& options) {
  const renderer::LoadedScene loaded = renderer::load_gltf(options.scene);
  const renderer::RayTracer tracer(loaded.scene);
  const renderer::Lights lights{renderer::PointLight{"light", tracer.bounds().center(), {10, 10, 10}}};
  renderer::RenderOptions rendering;
  rendering.width = 480, rendering.height = 270;
  rendering.time_limit = options.render_seconds;
  rendering.trace.samples = 1 << 20;
  const auto begin = std::chrono::steady_clock::now();
  double next = 0;
  renderer::Control control;
  control.report = [&](std::string_view, double) {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (seconds < next) return;
    print_row("seconds", seconds);
    next += options.render_seconds / double(options.rows);
  };
  renderer::render(tracer, renderer::default_camera(loaded.scene), lights, rendering, control);
  print_row("seconds", options.render_seconds);
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = parse(argc, argv);
  std::puts("after               resident MB  open files");
  const std::size_t step = std::max<std::size_t>(1, options.solves / options.rows);
  for (std::size_t k = 0; k < options.solves; ++k) {
    solve_once(options, k);
    if ((k + 1) % step == 0) print_row("solves", double(k + 1));
  }
  if (options.render_seconds > 0) render_for(options);
  return 0;
}

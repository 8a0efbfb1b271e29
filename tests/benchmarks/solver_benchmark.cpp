// How well solve finds random light sets again: count, error, positions, intensities and time, by count of lights.
//   solver_benchmark SCENE.glb --seed 1 --sets 20 --lights 1,3,5,6,7,9,11,16 --noise 0.01 --method both
// The light sets are those of random_light_sets.h.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "tests/benchmarks/exact_illumination.h"
#include "tests/benchmarks/parse_options.h"
#include "tests/benchmarks/random_light_sets.h"

namespace {

using namespace chiaro;
using namespace chiaro::inverse;
using namespace chiaro::benchmarks;
using renderer::PointLight;

struct Options {
  std::string scene, method = "joint";
  TargetOptions targets;
  std::uint64_t seed = 1;
  std::size_t sets = 20, first = 0;
  std::vector<std::size_t> lights{1, 3, 5, 6, 7, 9, 11, 16};
  int important_vertices = 1000;
  float max_edge = 0;
  bool verbose = false, from_truth = false;
};

Options parse(int argc, char** argv) {
  Options options;
  CLI::App app("How well solve finds random light sets again");
  app.add_option("scene", options.scene)->required();
  app.add_option("--seed", options.seed);
  app.add_option("--sets", options.sets, "Of each count of lights");
  app.add_option("--first", options.first, "Number of the first set");
  app.add_option("--lights", options.lights)->delimiter(',');
  app.add_option("--noise", options.targets.noise, "Of the targets, relative L2");
  app.add_option("--method", options.method, "none: targets are traced and kept, no more")
      ->check(CLI::IsMember({"joint", "thesis", "both", "none"}));
  app.add_option("--important-vertices", options.important_vertices);
  app.add_option("--max-edge", options.max_edge, "Of the receivers, metres");
  app.add_option("--targets", options.targets.folder,
                 "Folder that keeps the targets for later runs with the same options");
  app.add_flag("--from-truth", options.from_truth, "Nothing is searched: how well the true lights could be found");
  app.add_flag("--verbose", options.verbose, "What each set came to");
  parse_or_exit(app, argc, argv);
  return options;
}

struct NamedMethod {
  const char* name;
  SolveMethod method;
};

std::vector<NamedMethod> methods_of(const Options& options) {
  std::vector<NamedMethod> methods;
  if (options.method == "none") return methods;
  if (options.method != "joint") methods.push_back({"thesis", SolveMethod::kThesis});
  if (options.method != "thesis") methods.push_back({"joint", SolveMethod::kJoint});
  return methods;
}

// Of lights found, nearest pairs first; relative to the diagonal and to the true intensity.
struct Distances {
  std::vector<double> position, intensity;
  std::vector<std::size_t> too_many;       // found, of none of those that made the target
  std::size_t inside = 0, parameters = 0;  // of their 90 % intervals
};

Distances match(const std::vector<PointLight>& truth, const std::vector<FoundLight>& found, float diagonal) {
  struct Pair {
    float distance;
    std::size_t truth, found;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (std::size_t j = 0; j < found.size(); ++j) {
      pairs.push_back({length(truth[i].position - std::get<PointLight>(found[j].light).position), i, j});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  std::vector<bool> truth_taken(truth.size()), found_taken(found.size());
  Distances distances;
  for (const Pair& pair : pairs) {
    if (truth_taken[pair.truth] || found_taken[pair.found]) continue;
    truth_taken[pair.truth] = found_taken[pair.found] = true;
    distances.position.push_back(double(pair.distance / diagonal));
    const FoundLight& light = found[pair.found];
    const Vec3f wanted = truth[pair.truth].intensity;
    distances.intensity.push_back(
        double(length(std::get<PointLight>(light.light).intensity - wanted) / length(wanted)));
    for (int a = 0; a < 3; ++a) {
      const float off = std::abs(std::get<PointLight>(light.light).position[a] - truth[pair.truth].position[a]);
      distances.inside += off <= light.position_interval[a] ? 1 : 0;
      distances.inside +=
          std::abs(std::get<PointLight>(light.light).intensity[a] - wanted[a]) <= light.intensity_interval[a] ? 1 : 0;
      distances.parameters += 2;
    }
  }
  for (std::size_t j = 0; j < found.size(); ++j) {
    if (!found_taken[j]) distances.too_many.push_back(j);
  }
  return distances;
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, std::size_t(q * double(values.size())))];
}

struct Row {
  std::size_t exact = 0, off_by_more = 0, cases = 0, inside = 0, parameters = 0;
  std::vector<double> beyond, position, intensity, seconds, total;
};

struct Measurement {
  const Options& options;
  const Stage& stage;
  const TemporaryBake& bake;
  const ExactIllumination& exact;
};

void add_case(Row& row, const Measurement& with, const std::vector<PointLight>& truth, const SolveResult& result) {
  const long off = long(result.lights.size()) - long(truth.size());
  ++row.cases;
  row.exact += off == 0 ? 1 : 0;
  row.off_by_more += std::abs(off) > 1 ? 1 : 0;
  row.beyond.push_back(with.exact.error(truth, result.lights));
  const Distances distances = match(truth, result.lights, with.stage.diagonal);
  row.position.insert(row.position.end(), distances.position.begin(), distances.position.end());
  row.intensity.insert(row.intensity.end(), distances.intensity.begin(), distances.intensity.end());
  row.inside += distances.inside;
  row.parameters += distances.parameters;
  row.seconds.push_back(result.initial_seconds + result.optimal_seconds);
  row.total.push_back(result.total_seconds - result.cache_seconds);
}

void print_case(std::size_t set, const Measurement& with, const std::vector<PointLight>& truth,
                const SolveResult& result, double beyond) {
  const Distances distances = match(truth, result.lights, with.stage.diagonal);
  std::printf("  set %zu: %zu found, %.2f %% beyond noise, %zu of %zu intervals hold, %.2f s\n", set,
              result.lights.size(), 100 * beyond, distances.inside, distances.parameters,
              result.initial_seconds + result.optimal_seconds);
  for (std::size_t k = 0; k < distances.position.size(); ++k) {
    std::printf("    light %zu: %.3f %% off, intensity %.2f %%\n", k + 1, 100 * distances.position[k],
                100 * distances.intensity[k]);
  }
  for (const std::size_t j : distances.too_many) {
    std::printf("    one too many: contribution %.2f %%\n", 100 * result.lights[j].contribution);
  }
  std::printf("    error in %% by number of lights:");
  for (const LightSet& point : result.error_curve)
    std::printf(" %zu: %.3f", point.lights.size(), 100 * point.relative_l2);
  std::puts("");
  for (const StageReport& report : result.stages) {
    std::printf("    %-22s %6.2f s", report.name.c_str(), report.seconds);
    for (const auto& [name, value] : report.figures) std::printf("  %s %.4g", name.c_str(), value);
    std::puts("");
  }
  std::fflush(stdout);
}

void print_row(std::size_t lights, const NamedMethod& method, const Row& row) {
  std::printf("%6zu  %-6s %7zu %6.0f %8zu %8.2f %7.2f %9.3f %8.3f %9.2f %8.0f %8.2f %8.2f\n", lights, method.name,
              row.cases, 100 * double(row.exact) / double(row.cases), row.off_by_more, 100 * quantile(row.beyond, 0.5),
              100 * quantile(row.beyond, 1), 100 * quantile(row.position, 0.5), 100 * quantile(row.position, 0.95),
              100 * quantile(row.intensity, 0.5),
              100 * double(row.inside) / double(std::max<std::size_t>(1, row.parameters)), quantile(row.seconds, 0.5),
              quantile(row.total, 0.5));
  std::fflush(stdout);
}

SolveResult solve_by(const Measurement& with, const Target& target, const std::vector<PointLight>& truth,
                     SolveMethod method) {
  SolveOptions options;
  options.method = method;
  options.important_vertices = with.options.important_vertices;
  if (with.options.from_truth) options.earlier = {{truth, 0}};
  return solve({with.stage.tracer, target, with.bake.file(), {}, with.bake.settings(), {}}, options);
}

void measure_and_print(const Measurement& with, std::size_t count) {
  const std::vector<NamedMethod> methods = methods_of(with.options);
  std::vector<Row> rows(methods.size());
  const std::size_t first = with.options.first;
  for (std::size_t set = first; set < first + with.options.sets; ++set) {
    const SetNumber number{with.options.seed, count, set};
    const std::vector<PointLight> truth = random_lights(with.stage, number);
    const Target target = traced_target(with.stage, truth, number, with.options.targets);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const SolveResult result = solve_by(with, target, truth, methods[m].method);
      add_case(rows[m], with, truth, result);
      if (with.options.verbose) print_case(set, with, truth, result, rows[m].beyond.back());
    }
  }
  for (std::size_t m = 0; m < methods.size(); ++m) print_row(count, methods[m], rows[m]);
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = parse(argc, argv);
  const Stage stage(options.scene, options.max_edge);
  const ExactIllumination exact(stage);
  const TemporaryBake bake(stage);
  std::printf("%s, %zu receivers, noise %.1f %%, seed %llu\n", options.scene.c_str(), stage.receivers.size(),
              100 * options.targets.noise, static_cast<unsigned long long>(options.seed));
  std::puts(
      "lights  method   cases exact%  off > 1  beyond%  worst%  position%   95 %  intensity%  inside%  seconds  w/o "
      "bake");
  for (const std::size_t count : options.lights) measure_and_print({options, stage, bake, exact}, count);
  return 0;
}

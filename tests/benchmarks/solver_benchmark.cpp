// How well solve finds random light sets again: count, error, positions, intensities and time, by count of lights.
//   solver_benchmark SCENE.glb --seed 1 --sets 20 --lights 1,3,5,6,7,9,11,16 --noise 0.01 --method joint
// Lights stand in free space, at least 5 % of the scene's diagonal from each other and 3 % from surfaces; each gives at
// least 2 % of all illumination, their intensities are within a factor of 8, their colours random. Targets are traced
// to the noise asked for, with seeds that the solver does not use.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "inverse/solve/solve.h"
#include "inverse/transport/bake_file.h"
#include "renderer/core/sampler.h"
#include "renderer/io/load_gltf.h"
#include "renderer/trace/trace_illumination.h"

namespace {

using namespace chiaro;
using namespace chiaro::inverse;
using renderer::PointLight;
using renderer::RayTracer;

constexpr float kApart = 0.05F, kFromSurfaces = 0.03F;  // of the diagonal
constexpr double kLeastShare = 0.02;                    // of all illumination
constexpr float kIntensityRatio = 8;
constexpr int kPilotSamples = 16;
constexpr std::size_t kJudged = 4000;  // receivers

struct Options {
  std::string scene, method = "joint", targets;
  std::uint64_t seed = 1;
  std::size_t sets = 20;
  std::vector<std::size_t> lights{1, 3, 5, 6, 7, 9, 11, 16};
  double noise = 0.01;
  int important_vertices = 1000;
  float max_edge = 0;
  bool verbose = false;
};

Options parse(int argc, char** argv) {
  Options options;
  CLI::App app("How well solve finds random light sets again");
  app.add_option("scene", options.scene)->required();
  app.add_option("--seed", options.seed);
  app.add_option("--sets", options.sets, "Of each count of lights");
  app.add_option("--lights", options.lights)->delimiter(',');
  app.add_option("--noise", options.noise, "Of the targets, relative L2");
  app.add_option("--method", options.method)->check(CLI::IsMember({"joint", "thesis"}));
  app.add_option("--important-vertices", options.important_vertices);
  app.add_option("--max-edge", options.max_edge, "Of the receivers, metres");
  app.add_option("--targets", options.targets, "Folder that keeps the targets for later runs with the same options");
  app.add_flag("--verbose", options.verbose, "What each set came to");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Error& error) {
    std::exit(app.exit(error));
  }
  return options;
}

// Illumination without the noise of paths.
class ExactIllumination {
 public:
  ExactIllumination(const RayTracer& tracer, const Receivers& receivers)
      : tracer_(tracer),
        samples_(select_receivers(receivers, evenly_spread(receivers.size(), kJudged)).samples),
        gather_(make_gather_operator(tracer, samples_, {})) {}

  // ‖illumination by the lights found − by the true ones‖ / ‖the latter‖
  double error(const std::vector<PointLight>& truth, const std::vector<FoundLight>& found) const {
    std::vector<PointLight> lights;
    for (const FoundLight& light : found) lights.push_back(std::get<PointLight>(light.light));
    const std::vector<Vec3f> wanted = illumination(truth), got = illumination(lights);
    double difference = 0, norm = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      difference += double(length_squared(got[i] - wanted[i]));
      norm += double(length_squared(wanted[i]));
    }
    return std::sqrt(difference / norm);
  }

 private:
  std::vector<Vec3f> illumination(const std::vector<PointLight>& lights) const {
    std::vector<Vec3f> sum(samples_.size()), positions;
    for (const PointLight& light : lights) positions.push_back(light.position);
    const auto indirect = indirect_illumination_by_light(tracer_, gather_, positions);
    for (std::size_t j = 0; j < lights.size(); ++j) {
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        const bool lit = sees(tracer_, samples_[i], positions[j], std::uint32_t(i));
        const float direct = lit ? unoccluded_illumination(samples_[i], positions[j]) : 0;
        sum[i] += lights[j].intensity * (Vec3f{direct, direct, direct} + indirect[j][i]);
      }
    }
    return sum;
  }

  const RayTracer& tracer_;
  std::vector<renderer::SurfaceSample> samples_;
  GatherOperator gather_;
};

struct Stage {
  const RayTracer& tracer;
  const Receivers& receivers;
  Receivers some;  // of them
  ExactIllumination exact;
  float diagonal;
};

bool apart(const Stage& stage, const std::vector<PointLight>& lights, Vec3f position) {
  for (const PointLight& light : lights) {
    if (length(light.position - position) < kApart * stage.diagonal) return false;
  }
  for (const Vec3f p : stage.receivers.positions) {
    if (length(p - position) < kFromSurfaces * stage.diagonal) return false;
  }
  return true;
}

double sum_of(const std::vector<Vec3f>& values) {
  double sum = 0;
  for (const Vec3f v : values) sum += double(v.x + v.y + v.z);
  return sum;
}

bool each_matters(const Stage& stage, const std::vector<PointLight>& lights) {
  std::vector<double> given;
  for (const PointLight& light : lights) {
    given.push_back(sum_of(trace_illumination(stage.tracer, stage.some.samples, {light}, {8, -1, 77, false}).value));
  }
  double all = 0;
  for (const double g : given) all += g;
  return *std::min_element(given.begin(), given.end()) >= kLeastShare * all;
}

std::vector<PointLight> random_lights(const Stage& stage, const Box3f& region, std::size_t count, std::uint64_t seed) {
  for (std::uint64_t attempt = 0;; ++attempt) {
    std::vector<PointLight> lights;
    const auto places = random_light_positions(stage.tracer, region, 200, seed * 1000 + attempt);
    for (std::uint32_t i = 0; i < places.size() && lights.size() < count; ++i) {
      if (!apart(stage, lights, places[i])) continue;
      renderer::Sampler sampler(seed + 17, std::uint32_t(attempt), i);
      const renderer::Vec2f u = sampler.next_2d();
      const float intensity = 5 * std::pow(kIntensityRatio, u.x);
      Vec3f color{0.15F + 0.85F * u.y, 0.15F + 0.85F * sampler.next_1d(), 0.15F + 0.85F * sampler.next_1d()};
      color = color / max_component(color);
      lights.push_back({"", places[i], intensity * color});
    }
    if (lights.size() == count && each_matters(stage, lights)) return lights;
  }
}

Target traced_target(const Stage& stage, const std::vector<PointLight>& lights, double noise, std::uint64_t seed) {
  renderer::Lights all(lights.begin(), lights.end());
  const auto pilot =
      trace_illumination(stage.tracer, stage.some.samples, all, {kPilotSamples, -1, seed * 7919 + 5, true});
  const double ratio = relative_standard_error(pilot) / noise;
  const int samples = std::max(4, int(std::ceil(kPilotSamples * ratio * ratio)));
  const auto traced =
      trace_illumination(stage.tracer, stage.receivers.samples, all, {samples, -1, seed * 7919 + 6, true});
  return {stage.receivers, traced.value, std::vector<float>(stage.receivers.size(), 1),
          standard_error_per_receiver(traced)};
}

// Traced unless an earlier run did it.
Target kept_target(const Stage& stage, const std::vector<PointLight>& lights, const Options& options,
                   std::uint64_t seed) {
  if (options.targets.empty()) return traced_target(stage, lights, options.noise, seed);
  const auto file = std::filesystem::path(options.targets) /
                    fmt::format("{}_{}_{}_{}.glb", std::filesystem::path(options.scene).stem().string(),
                                options.max_edge, options.noise, seed);
  if (!std::filesystem::exists(file)) {
    std::filesystem::create_directories(options.targets);
    save_target(traced_target(stage, lights, options.noise, seed), file);
  }
  return load_target(file);
}

// Of lights found, nearest pairs first; relative to the diagonal and to the true intensity.
struct Distances {
  std::vector<double> position, intensity;
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

void add_case(Row& row, const Stage& stage, const std::vector<PointLight>& truth, const SolveResult& result) {
  const long off = long(result.lights.size()) - long(truth.size());
  ++row.cases;
  row.exact += off == 0 ? 1 : 0;
  row.off_by_more += std::abs(off) > 1 ? 1 : 0;
  row.beyond.push_back(stage.exact.error(truth, result.lights));
  const Distances distances = match(truth, result.lights, stage.diagonal);
  row.position.insert(row.position.end(), distances.position.begin(), distances.position.end());
  row.intensity.insert(row.intensity.end(), distances.intensity.begin(), distances.intensity.end());
  row.inside += distances.inside;
  row.parameters += distances.parameters;
  row.seconds.push_back(result.initial_seconds + result.optimal_seconds);
  row.total.push_back(result.total_seconds - result.cache_seconds);
}

void print_case(std::size_t set, const Stage& stage, const std::vector<PointLight>& truth, const SolveResult& result,
                double beyond) {
  std::printf("  set %zu: %zu found, %.2f %% beyond noise\n", set, result.lights.size(), 100 * beyond);
  const Distances distances = match(truth, result.lights, stage.diagonal);
  for (std::size_t k = 0; k < distances.position.size(); ++k) {
    std::printf("    light %zu: %.3f %% off, intensity %.2f %%\n", k + 1, 100 * distances.position[k],
                100 * distances.intensity[k]);
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

void print_row(std::size_t lights, const Row& row) {
  std::printf("%6zu %7zu %6.0f %8zu %8.2f %7.2f %9.3f %8.3f %9.2f %8.0f %8.2f %8.2f\n", lights, row.cases,
              100 * double(row.exact) / double(row.cases), row.off_by_more, 100 * quantile(row.beyond, 0.5),
              100 * quantile(row.beyond, 1), 100 * quantile(row.position, 0.5), 100 * quantile(row.position, 0.95),
              100 * quantile(row.intensity, 0.5),
              100 * double(row.inside) / double(std::max<std::size_t>(1, row.parameters)), quantile(row.seconds, 0.5),
              quantile(row.total, 0.5));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = parse(argc, argv);
  const renderer::LoadedScene loaded = renderer::load_gltf(options.scene);
  const RayTracer tracer(loaded.scene);
  const Receivers receivers = make_receivers(loaded.scene, {.max_edge = options.max_edge});
  const Stage stage{tracer, receivers, select_receivers(receivers, evenly_spread(receivers.size(), 1000)),
                    ExactIllumination(tracer, receivers), tracer.bounds().diagonal()};
  const BakeSettings settings{.samples = 256, .bounces = -1, .seed = 0, .materials = "gltf"};
  const LightGrid grid = make_light_grid(tracer, {});
  const auto cache = std::filesystem::temp_directory_path() / ("solver_benchmark_" + std::to_string(getpid()) + ".exr");
  Baker baker(tracer, receivers, grid, settings, 4e9);
  bake_to_file(baker, cache, {}, {});

  std::printf("%s, %zu receivers, noise %.1f %%, method %s, seed %llu\n", options.scene.c_str(), receivers.size(),
              100 * options.noise, options.method.c_str(), static_cast<unsigned long long>(options.seed));
  std::puts(
      "lights   cases exact%  off > 1  beyond%  worst%  position%   95 %  intensity%  inside%  seconds  w/o bake");
  for (const std::size_t count : options.lights) {
    Row row;
    for (std::size_t set = 0; set < options.sets; ++set) {
      const std::uint64_t seed = (options.seed * 100 + count) * 1000 + set;
      const std::vector<PointLight> truth = random_lights(stage, grid.region, count, seed);
      const Target target = kept_target(stage, truth, options, seed);
      SolveOptions solve_options;
      solve_options.method = options.method == "thesis" ? SolveMethod::kThesis : SolveMethod::kJoint;
      solve_options.verification_samples = 32;
      solve_options.important_vertices = options.important_vertices;
      const SolveResult result = solve({tracer, target, cache, {}, settings, {}}, solve_options);
      add_case(row, stage, truth, result);
      if (options.verbose) print_case(set, stage, truth, result, row.beyond.back());
    }
    print_row(count, row);
  }
  std::filesystem::remove(cache);
  return 0;
}

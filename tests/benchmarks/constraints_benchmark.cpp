// Whether solve keeps to constraints, whatever they are: random ones on four scenes in turn, checked by other means.
//   constraints_benchmark --seed 1 --cases 1000 [--time-limit 0.001]
// Receivers are few and light is direct or bounces once, so that a solve takes a fraction of a second.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <unistd.h>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/constraint_options.h"
#include "cli/usage_error.h"
#include "renderer/core/error.h"
#include "renderer/core/seconds_since.h"
#include "tests/benchmarks/constraint_checks.h"
#include "tests/benchmarks/parse_options.h"
#include "tests/benchmarks/random_constraints.h"

namespace {

using namespace chiaro;
using namespace chiaro::inverse;
using namespace chiaro::benchmarks;

constexpr std::size_t kScenes = 4, kTargets = 4;
constexpr int kMostLights = 5;    // where constraints do not say
constexpr float kMaxEdge = 0.1F;  // of the receivers, of the diagonal

struct Options {
  std::uint64_t seed = 1;
  std::size_t cases = 1000;
  std::size_t first = 0;
  double time_limit = 0;
  bool verbose = false;
};

Options parse(int argc, char** argv) {
  Options options;
  CLI::App app("Whether solve keeps to constraints");
  app.add_option("--seed", options.seed);
  app.add_option("--cases", options.cases);
  app.add_option("--first", options.first, "Number of the first case");
  app.add_option("--time-limit", options.time_limit, "Of each solve, seconds, beside transport; 0: none");
  app.add_flag("--verbose", options.verbose, "What each case is and what it came to");
  parse_or_exit(app, argc, argv);
  return options;
}

// A target that all cases of its scene share, and what a solve without constraints leaves of it.
struct SharedTarget {
  Target target;
  int bounces = 0;
  double free_error = 0;
};

SolveProblem problem_of(const Stage& stage, const SharedTarget& shared) {
  SolveProblem problem{stage.tracer, shared.target, {}, {}, {16, shared.bounces, 0, "gltf"}, {}};
  problem.grid.lights = 200;
  return problem;
}

SolveOptions options_of(const LightConstraints& constraints, SolveMethod method, double time_limit = 0) {
  SolveOptions options;
  options.time_limit = time_limit;
  options.method = method;
  options.important_vertices = 150;
  options.verification_samples = 4;
  options.max_lights = constraints.max_lights.value_or(kMostLights);
  options.exact_lights = constraints.lights.value_or(0);
  return options;
}

// The last one of a scene bounces.
SharedTarget shared_target(const Stage& stage, std::uint64_t seed, std::size_t number) {
  SharedTarget shared;
  shared.bounces = number + 1 == kTargets ? 1 : 0;
  const auto truth = random_lights(stage, {seed, 1 + number, 0});
  const renderer::Lights lights(truth.begin(), truth.end());
  const auto traced =
      trace_illumination(stage.tracer, stage.some.samples, lights, {16, shared.bounces, seed + 91, true});
  shared.target = {stage.some, traced.value, std::vector<float>(stage.some.size(), 1),
                   standard_error_per_receiver(traced)};
  shared.free_error = solve(problem_of(stage, shared), options_of({}, SolveMethod::kJoint)).relative_l2_cached;
  return shared;
}

struct Setting {
  std::unique_ptr<const Stage> stage;
  std::vector<SharedTarget> targets;
};

Setting setting(const std::string& name, std::uint64_t seed) {
  const auto file = std::filesystem::path(CHIARO_SOURCE_DIR) / "scenes" / (name + ".glb");
  const float diagonal = renderer::RayTracer(renderer::load_gltf(file).scene).bounds().diagonal();
  Setting made{std::make_unique<const Stage>(file, kMaxEdge * diagonal), {}};
  for (std::size_t k = 0; k < kTargets; ++k) made.targets.push_back(shared_target(*made.stage, seed, k));
  return made;
}

// Constraints as users give them: by a file.
LightConstraints read_back(const LightConstraints& constraints) {
  const auto file = std::filesystem::temp_directory_path() / fmt::format("chiaro_constraints_{}.json", getpid());
  std::ofstream(file) << json_of(constraints);
  const auto remove = [&] { std::filesystem::remove(file); };
  try {
    const LightConstraints read = cli::choose_constraints({{}, file.string()}, {});
    remove();
    return read;
  } catch (...) {
    remove();
    throw;
  }
}

SolveResult solve_case(const Setting& setting, const SharedTarget& shared, const ConstraintCase& c, double time_limit) {
  const LightConstraints constraints = read_back(c.constraints);
  cli::require_known_to(c.method, constraints, {{}, "constraints.json"});
  SolveProblem problem = problem_of(*setting.stage, shared);
  const renderer::Scene& scene = setting.stage->loaded.scene;
  if (constraints.keep_lights) problem.kept_lights = c.scene_lights;
  if (constraints.keep_positions) problem.lights_in_place = c.scene_lights;
  problem.places = cli::place_rules(scene, constraints);
  problem.intensities = cli::intensity_rules(constraints);
  problem.grid = around_places(problem.grid, scene, problem.places);
  return solve(problem, options_of(constraints, c.method, time_limit));
}

// What an error must speak of, if it names a constraint that there is.
bool names_a_constraint(const std::string& error, const LightConstraints& c) {
  const auto speaks_of = [&](const char* text) { return error.find(text) != std::string::npos; };
  const bool ruled_places = !c.regions.empty() || !c.mounts.empty();
  return (c.surface_distance && speaks_of("to any surface")) ||
         (c.surface_distance && speaks_of("m from all surfaces")) || (c.light_distance && speaks_of("m apart")) ||
         (c.light_distance && speaks_of("m from those that stay")) || (ruled_places && speaks_of("region")) ||
         (!c.mounts.empty() && speaks_of("hang")) || (c.keep_positions && speaks_of("the scene's lights")) ||
         (c.keep_positions && speaks_of("stays where it is"));
}

bool is_contradiction(const std::string& error) { return error.find("exclude each other") != error.npos; }

// But for places that light nothing, or nothing that is wanted.
bool speaks_of_places(const std::string& error) {
  return error.find("lights the painted surfaces") == error.npos && error.find("closer to the target") == error.npos;
}

struct Tally {
  std::size_t solves = 0, infeasible = 0, refused = 0, unclear = 0, places_after_all = 0;
  std::map<std::string, std::size_t> violations, errors;
  std::vector<double> excess;  // of the error, over that without constraints
};

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, std::size_t(q * double(values.size())))];
}

void print_case(const ConstraintCase& c, const std::string& what) {
  std::printf("case %zu%s: %s  %s\n", c.number, c.method == SolveMethod::kThesis ? " (thesis)" : "", what.c_str(),
              json_of(c.constraints).c_str());
  std::fflush(stdout);
}

// Without the numbers in it.
std::string kind_of(const std::string& error) {
  const std::size_t at = error.find("no light possible");
  std::string kind;
  for (const char ch : at == error.npos ? error : error.substr(at)) {
    if (std::isdigit(static_cast<unsigned char>(ch)) == 0 && ch != '.') kind += ch;
  }
  return kind.substr(0, 90);
}

void tally_result(const Setting& setting, const SharedTarget& shared, const ConstraintCase& c,
                  const SolveResult& result, Tally& tally) {
  ++tally.solves;
  tally.excess.push_back(result.relative_l2_cached - shared.free_error);
  const auto check = [&](const LightConstraints& constraints, const std::vector<FoundLight>& lights) {
    for (const Violation& v : violations(setting.stage->loaded.scene, constraints, c.scene_lights, lights)) {
      ++tally.violations[v.kind];
      print_case(c, "VIOLATION " + v.kind + ": " + v.what);
    }
  };
  check(c.constraints, result.lights);
  LightConstraints of_any_number = c.constraints;
  of_any_number.lights.reset(), of_any_number.max_lights.reset();
  for (const LightSet& set : result.error_curve) {
    std::vector<FoundLight> lights;
    for (const renderer::PointLight& light : set.lights) lights.push_back({light, 0, {}, {}});
    check(of_any_number, lights);
  }
}

void tally_error(const Setting& setting, const ConstraintCase& c, const std::string& error, Tally& tally) {
  if (is_contradiction(error)) {
    ++tally.refused;
    return;
  }
  ++tally.infeasible;
  ++tally.errors[kind_of(error)];
  if (!names_a_constraint(error, c.constraints)) {
    ++tally.unclear;
    print_case(c, "UNCLEAR " + error);
  } else if (!c.constraints.keep_positions && speaks_of_places(error) &&
             places_exist(setting.stage->tracer, c.constraints, c.scene_lights, 7)) {
    ++tally.places_after_all;
    print_case(c, "PLACES EXIST " + error);
  }
}

void run_case(const Setting& setting, const ConstraintCase& c, const Options& options, Tally& tally) {
  const SharedTarget& shared = setting.targets[c.number / kScenes % kTargets];
  const bool verbose = options.verbose;
  if (verbose) print_case(c, "begins");
  try {
    const SolveResult result = solve_case(setting, shared, c, options.time_limit);
    tally_result(setting, shared, c, result, tally);
    if (verbose) {
      print_case(c, fmt::format("{} lights, error {:.4f}, without constraints {:.4f}", result.lights.size(),
                                result.relative_l2_cached, shared.free_error));
      for (const StageReport& stage : result.stages) std::printf("  %-24s %.3f s\n", stage.name.c_str(), stage.seconds);
    }
  } catch (const cli::UsageError& error) {
    ++tally.refused;
    if (verbose) print_case(c, error.what());
  } catch (const renderer::Error& error) {
    tally_error(setting, c, error.what(), tally);
    if (verbose) print_case(c, error.what());
  }
}

std::size_t sum_of(const std::map<std::string, std::size_t>& counts) {
  std::size_t sum = 0;
  for (const auto& [kind, count] : counts) sum += count;
  return sum;
}

void print_tally(const Tally& tally, double seconds) {
  std::printf("\nsolved %zu, named infeasible %zu, refused as contradictory %zu, in %.0f s\n", tally.solves,
              tally.infeasible, tally.refused, seconds);
  std::printf("violations %zu, errors that name no constraint %zu, named infeasible though places exist %zu\n",
              sum_of(tally.violations), tally.unclear, tally.places_after_all);
  for (const auto& [kind, count] : tally.violations) std::printf("  %5zu  %s\n", count, kind.c_str());
  std::puts("errors:");
  for (const auto& [kind, count] : tally.errors) std::printf("  %5zu  %s\n", count, kind.c_str());
  std::printf("error above that without constraints: quartiles %.4f, %.4f, %.4f\n", quantile(tally.excess, 0.25),
              quantile(tally.excess, 0.5), quantile(tally.excess, 0.75));
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = parse(argc, argv);
  std::vector<Setting> settings;
  for (const char* name : {"fiveballs", "twotoy", "bedroom", "cornell"}) {
    settings.push_back(setting(name, options.seed));
    std::printf("%s: %zu receivers, error without constraints", name, settings.back().stage->some.size());
    for (const SharedTarget& shared : settings.back().targets) std::printf(" %.4f", shared.free_error);
    std::puts("");
  }
  Tally tally;
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t number = options.first; number < options.first + options.cases; ++number) {
    const Setting& setting = settings[number % kScenes];
    run_case(setting, random_case(*setting.stage, options.seed, number), options, tally);
  }
  print_tally(tally, renderer::seconds_since(start));
  return tally.violations.empty() && tally.unclear == 0 ? 0 : 1;
}

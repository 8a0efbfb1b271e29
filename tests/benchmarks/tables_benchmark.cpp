// The published tables 4.1 to 4.4 as measured here: what is published beside --method thesis and the default method.
//   tables_benchmark scenes/fiveballs.glb --seed 1 --sets 5 --tables 4.1,4.3
// Each row is the median over the light sets of random_light_sets.h, the same ones for both methods; of guessed lights,
// fewest and most. Error: relative L2 over all receivers, traced afresh, against the target. Noise: what of it that
// of the target makes. Beyond: what lights without any noise differ by. Total seconds: all of a solve but for reading
// the bake and tracing the error.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "tests/benchmarks/exact_illumination.h"
#include "tests/benchmarks/parse_options.h"
#include "tests/benchmarks/published_tables.h"
#include "tests/benchmarks/random_light_sets.h"

namespace {

using namespace chiaro;
using namespace chiaro::inverse;
using namespace chiaro::benchmarks;

struct Options {
  std::string scene;
  std::vector<std::string> tables{"4.1", "4.2", "4.3", "4.4"};
  TargetOptions targets;
  std::uint64_t seed = 1;
  std::size_t sets = 5;
  float max_edge = 0;
  int verification_samples = 0;
};

Options parse(int argc, char** argv) {
  Options options;
  CLI::App app("The published tables as measured here");
  app.add_option("scene", options.scene)->required();
  app.add_option("--tables", options.tables)->delimiter(',')->check(CLI::IsMember({"4.1", "4.2", "4.3", "4.4"}));
  app.add_option("--seed", options.seed);
  app.add_option("--sets", options.sets, "Light sets per row");
  app.add_option("--noise", options.targets.noise, "Of the targets, relative L2");
  app.add_option("--max-edge", options.max_edge, "Of the receivers, metres");
  app.add_option("--targets", options.targets.folder,
                 "Folder that keeps the targets for later runs with the same options");
  app.add_option("--verification-samples", options.verification_samples, "Paths per receiver; 0: as solve chooses");
  parse_or_exit(app, argc, argv);
  return options;
}

// Of a row, over all light sets.
struct Outcome {
  std::vector<int> guessed;
  std::vector<double> error, noise, beyond, total, initial, optimal;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double verification_seconds(const SolveResult& result) {
  double seconds = 0;
  for (const StageReport& stage : result.stages) seconds += stage.name == "verification" ? stage.seconds : 0;
  return seconds;
}

class Laboratory {
 public:
  explicit Laboratory(const Options& options)
      : options_(options), stage_(options.scene, options.max_edge), exact_(stage_), bake_(stage_) {}

  const Stage& stage() const { return stage_; }

  // Measured once, in however many tables the row stands.
  const Outcome& outcome(const PublishedRow& row, SolveMethod method) {
    const auto [place, is_new] = outcomes_.try_emplace({row.important_vertices, row.lights, row.exact_lights, method});
    for (std::size_t set = 0; is_new && set < options_.sets; ++set) add(row, method, set, place->second);
    return place->second;
  }

 private:
  void add(const PublishedRow& row, SolveMethod method, std::size_t set, Outcome& outcome) const {
    const SetNumber number{options_.seed, std::size_t(row.lights), set};
    const auto truth = random_lights(stage_, number);
    const Target target = traced_target(stage_, truth, number, options_.targets);
    const SolveResult result = solved(row, method, target);
    outcome.guessed.push_back(int(result.lights.size()));
    outcome.error.push_back(100 * result.relative_l2);
    outcome.noise.push_back(100 * result.target_noise);
    outcome.beyond.push_back(100 * exact_.error(truth, result.lights));
    outcome.total.push_back(result.total_seconds - result.cache_seconds - verification_seconds(result));
    outcome.initial.push_back(result.initial_seconds);
    outcome.optimal.push_back(result.optimal_seconds);
    fmt::print(stderr, "{} vertices, {} lights, set {}: {} by {}, {:.2f} %, {:.1f} s\n", row.important_vertices,
               row.lights, set, outcome.guessed.back(), method == SolveMethod::kThesis ? "thesis" : "default",
               outcome.error.back(), outcome.total.back());
  }

  SolveResult solved(const PublishedRow& row, SolveMethod method, const Target& target) const {
    SolveOptions options;
    options.method = method;
    options.important_vertices = row.important_vertices;
    options.exact_lights = row.exact_lights;
    options.verification_samples = options_.verification_samples;
    return solve({stage_.tracer, target, bake_.file(), {}, bake_.settings(), {}}, options);
  }

  Options options_;
  Stage stage_;
  ExactIllumination exact_;
  TemporaryBake bake_;
  std::map<std::tuple<int, int, int, SolveMethod>, Outcome> outcomes_;
};

void print_head(const PublishedTable& table) {
  fmt::print("\nTable {}: {}\n\n", table.number, table.caption);
  fmt::print(
      "| vertices | lights | method    | guessed | error % | noise % | beyond % | total s | initial s | optimal s |\n");
  fmt::print(
      "| -------: | -----: | --------- | ------: | ------: | ------: | -------: | ------: | --------: | --------: |\n");
}

void print_published(const PublishedRow& row) {
  fmt::print("| {:8} | {:6} | published | {:>7} | {:7.2f} | {:7} | {:8} |", row.important_vertices, row.lights,
             row.guessed_lights, row.error_percent, "", "");
  if (row.total_seconds > 0) {
    fmt::print(" {:7.2f} | {:9.2f} | {:9.2f} |\n", row.total_seconds, row.initial_seconds, row.optimal_seconds);
  } else {
    fmt::print(" {:7} | {:9} | {:9} |\n", "", "", "");
  }
}

std::string range_of(const std::vector<int>& counts) {
  const auto [fewest, most] = std::minmax_element(counts.begin(), counts.end());
  return *fewest == *most ? fmt::format("{}", *fewest) : fmt::format("{}-{}", *fewest, *most);
}

void print_measured(const char* method, const Outcome& outcome) {
  fmt::print("| {:8} | {:6} | {:9} | {:>7} | {:7.2f} | {:7.2f} | {:8.2f} | {:7.2f} | {:9.2f} | {:9.2f} |\n", "", "",
             method, range_of(outcome.guessed), median(outcome.error), median(outcome.noise), median(outcome.beyond),
             median(outcome.total), median(outcome.initial), median(outcome.optimal));
  std::fflush(stdout);
}

void print_table(const PublishedTable& table, Laboratory& laboratory) {
  print_head(table);
  for (const PublishedRow& row : table.rows) {
    print_published(row);
    print_measured("thesis", laboratory.outcome(row, SolveMethod::kThesis));
    print_measured("default", laboratory.outcome(row, SolveMethod::kJoint));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = parse(argc, argv);
  Laboratory laboratory(options);
  fmt::print("{}, {} receivers, {} grid lights, noise {} %, seed {}, {} light sets per row\n", options.scene,
             laboratory.stage().receivers.size(), laboratory.stage().grid.positions.size(), 100 * options.targets.noise,
             options.seed, options.sets);
  for (const PublishedTable& table : published_tables()) {
    if (std::count(options.tables.begin(), options.tables.end(), table.number) > 0) print_table(table, laboratory);
  }
  return 0;
}

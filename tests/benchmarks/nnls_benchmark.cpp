// Non-negative least squares beside SciPy's, on the same matrices in the same run.
//   nnls_benchmark scenes/fiveballs.glb --repeats 3 --python /usr/bin/python3
// Seconds: the least of the repeats. Products: nnls(), with AᵀA and Aᵀb. Set: working_set_nnls(); warm: the same from
// what an earlier round found. ‖r‖: the residual norm over ‖b‖; off: ours less SciPy's. KKT: the largest violation of
// the KKT conditions, computed from A, b and x alike for all; relative to the largest |Aᵀb|, with columns of unit
// length.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>

#include <unistd.h>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "inverse/numerics/working_set_nnls.h"
#include "renderer/core/seconds_since.h"
#include "tests/benchmarks/nnls_cases.h"
#include "tests/benchmarks/parse_options.h"

namespace {

using namespace chiaro::benchmarks;
using chiaro::inverse::numerics::nnls;
using chiaro::inverse::numerics::working_set_nnls;
using chiaro::renderer::seconds_since;
using Eigen::MatrixXd;

constexpr int kColumns = 18;  // of what is printed

struct Options {
  std::string scene, python = "/usr/bin/python3", only;
  TargetOptions targets;
  std::uint64_t seed = 1;
  std::size_t lights = 6;
  int repeats = 3;
  float max_edge = 0;
};

Options parse(int argc, char** argv) {
  Options options;
  CLI::App app("Non-negative least squares beside SciPy's");
  app.add_option("scene", options.scene, "Of transport; without it, the synthetic cases alone");
  app.add_option("--seed", options.seed);
  app.add_option("--lights", options.lights, "Of the target");
  app.add_option("--repeats", options.repeats)->check(CLI::PositiveNumber);
  app.add_option("--python", options.python, "One with SciPy; none: \"\"");
  app.add_option("--only", options.only, "Cases whose names contain this");
  app.add_option("--max-edge", options.max_edge, "Of the receivers, metres");
  app.add_option("--targets", options.targets.folder, "Folder that keeps the target for later runs");
  parse_or_exit(app, argc, argv);
  return options;
}

struct Solution {
  MatrixXd x;  // empty: failed
  double seconds = std::numeric_limits<double>::infinity();
};

// The least seconds of a few calls.
template <class F>
double least_seconds(int repeats, F&& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < repeats; ++k) {
    const auto start = std::chrono::steady_clock::now();
    work();
    least = std::min(least, seconds_since(start));
  }
  return least;
}

MatrixXd gram_of(const MatrixXd& a) {
  MatrixXd gram = MatrixXd::Zero(a.cols(), a.cols());
  gram.selfadjointView<Eigen::Lower>().rankUpdate(a.transpose());
  gram.triangularView<Eigen::StrictlyUpper>() = gram.transpose();
  return gram;
}

template <class F>
Solution solve_by(int repeats, F&& solve) {
  Solution solution;
  solution.seconds = least_seconds(repeats, [&] { solution.x = solve().x; });
  return solution;
}

struct Solutions {
  Solution by_products, by_working_set, warm, scipy;
};

Solution solve_by_products(const NnlsCase& problem, int repeats) {
  return solve_by(repeats, [&] { return nnls(gram_of(problem.a), problem.a.transpose() * problem.b); });
}

void write(const MatrixXd& matrix, const std::filesystem::path& file) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(matrix.data()), std::streamsize(matrix.size() * sizeof(double)));
}

MatrixXd read(Eigen::Index rows, Eigen::Index columns, const std::filesystem::path& file) {
  MatrixXd matrix(rows, columns);
  std::ifstream(file, std::ios::binary)
      .read(reinterpret_cast<char*>(matrix.data()), std::streamsize(matrix.size() * sizeof(double)));
  return matrix;
}

// Matrices go through files in a temporary folder, column by column.
Solution solve_by_scipy(const NnlsCase& problem, const Options& options) {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("chiaro_nnls_benchmark_{}", getpid());
  std::filesystem::create_directories(folder);
  write(problem.a, folder / "a");
  write(problem.b, folder / "b");
  const std::string command =
      fmt::format("{} {}/tests/benchmarks/nnls_benchmark.py {} {} {} {} {}", options.python, CHIARO_SOURCE_DIR,
                  folder.string(), problem.a.rows(), problem.a.cols(), problem.b.cols(), options.repeats);
  Solution solution;
  if (std::system(command.c_str()) == 0) {
    solution.x = read(problem.a.cols(), problem.b.cols(), folder / "x");
    solution.seconds = read(1, 1, folder / "seconds")(0);
  }
  std::filesystem::remove_all(folder);
  return solution;
}

Solutions solve(const NnlsCase& problem, const Options& options) {
  const auto working_set = [&] { return working_set_nnls(problem.a, problem.b); };
  const auto warm = [&] { return working_set_nnls(problem.a, problem.b, {}, &problem.start); };
  return {solve_by_products(problem, options.repeats), solve_by(options.repeats, working_set),
          solve_by(options.repeats, warm), options.python.empty() ? Solution{} : solve_by_scipy(problem, options)};
}

double residual_norm(const NnlsCase& problem, const MatrixXd& x) {
  return (problem.a * x - problem.b).norm() / problem.b.norm();
}

double kkt_violation(const NnlsCase& problem, const MatrixXd& x) {
  if (x.size() == 0) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::ArrayXd length = problem.a.colwise().norm().transpose();
  const Eigen::ArrayXd inverse_length = (length > 0).select(1 / length, 0);
  const MatrixXd gradient = inverse_length.matrix().asDiagonal() * problem.a.transpose() * (problem.b - problem.a * x);
  const MatrixXd products = inverse_length.matrix().asDiagonal() * problem.a.transpose() * problem.b;
  double worst = 0;
  for (Eigen::Index side = 0; side < x.cols(); ++side) {
    const Eigen::ArrayXd w = gradient.col(side).array();
    const double violation = (x.col(side).array() > 0).select(w.abs(), w).maxCoeff();
    worst = std::max(worst, violation / products.col(side).cwiseAbs().maxCoeff());
  }
  return worst;
}

void print_head() {
  fmt::print("| {:<24} | rows | columns | sides |  lit | SciPy s | products s |     × | set s |     × | warm s ",
             "case");
  fmt::print("|    ‖r‖ | off, products | off, set | KKT SciPy | products |     set |    warm |\n| --- ");
  for (int column = 1; column < kColumns; ++column) fmt::print("| --: ");
  fmt::print("|\n");
}

double off(const NnlsCase& problem, const Solution& ours, const Solution& scipys) {
  if (scipys.x.size() == 0) return std::numeric_limits<double>::quiet_NaN();
  return residual_norm(problem, ours.x) - residual_norm(problem, scipys.x);
}

void print_case(const NnlsCase& problem, const Solutions& by) {
  fmt::print("| {:<24} | {:>4} | {:>7} | {:>5} | {:>4} ", problem.name, problem.a.rows(), problem.a.cols(),
             problem.b.cols(), (by.by_working_set.x.array() > 0).count());
  fmt::print("| {:>7.3f} | {:>10.3f} | {:>5.1f} | {:>5.3f} | {:>5.1f} | {:>6.3f} ", by.scipy.seconds,
             by.by_products.seconds, by.scipy.seconds / by.by_products.seconds, by.by_working_set.seconds,
             by.scipy.seconds / by.by_working_set.seconds, by.warm.seconds);
  fmt::print("| {:>6.4f} | {:>13.0e} | {:>8.0e} ", residual_norm(problem, by.by_working_set.x),
             off(problem, by.by_products, by.scipy), off(problem, by.by_working_set, by.scipy));
  fmt::print("| {:>9.0e} | {:>8.0e} | {:>7.0e} | {:>7.0e} |\n", kkt_violation(problem, by.scipy.x),
             kkt_violation(problem, by.by_products.x), kkt_violation(problem, by.by_working_set.x),
             kkt_violation(problem, by.warm.x));
  std::fflush(stdout);
}

std::vector<NnlsCase> cases_of(const Options& options) {
  std::vector<NnlsCase> cases;
  if (!options.scene.empty()) {
    const Stage stage(options.scene, options.max_edge);
    cases = transport_cases(stage, {options.seed, options.lights, 0}, options.targets);
  }
  for (NnlsCase& problem : synthetic_cases(unsigned(options.seed))) cases.push_back(std::move(problem));
  return cases;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = parse(argc, argv);
  print_head();
  for (const NnlsCase& problem : cases_of(options)) {
    if (problem.name.find(options.only) == std::string::npos) continue;
    print_case(problem, solve(problem, options));
  }
  return 0;
}

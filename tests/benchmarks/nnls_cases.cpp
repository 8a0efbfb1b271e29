#include "tests/benchmarks/nnls_cases.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "inverse/numerics/nnls.h"
#include "inverse/solve/important_vertices.h"
#include "inverse/solve/observe_target.h"

namespace chiaro::benchmarks {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using inverse::Column;

constexpr std::size_t kManyColumns = 3000;
constexpr int kGreen = 1;
constexpr double kOtherNoise = 0.01;  // between a start's right-hand sides and a case's

MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::mt19937& random) {
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

// Powers of ten between ± `exponent`.
VectorXd wild_factors(Eigen::Index count, double exponent, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-exponent, exponent);
  return VectorXd::NullaryExpr(count, [&] { return std::pow(10.0, uniform(random)); });
}

MatrixXd solution_of(const MatrixXd& a, const MatrixXd& b) {
  return inverse::numerics::nnls(a.transpose() * a, a.transpose() * b).x;
}

// Starts from the solution for nearly the same right-hand sides.
NnlsCase with_start(std::string name, MatrixXd a, MatrixXd b, std::mt19937& random) {
  const double noise = kOtherNoise * b.norm() / std::sqrt(double(b.size()));
  MatrixXd start = solution_of(a, b + noise * random_matrix(b.rows(), b.cols(), random));
  return {std::move(name), std::move(a), std::move(b), std::move(start)};
}

// Lights of a round, and what of them an earlier round found.
struct Round {
  std::vector<Column> columns;
  VectorXd found;
};

struct Observed {
  inverse::Observations observations;
  inverse::BakeResult bake;
  std::vector<renderer::SurfaceSample> samples;
};

Observed observe(const Stage& stage, SetNumber number, const TargetOptions& options) {
  const inverse::Target target = traced_target(stage, random_lights(stage, number), number, options);
  const auto importance = inverse::choose_important_vertices(stage.tracer, target, {});
  const inverse::Receivers receivers = inverse::select_receivers(target.receivers, importance.chosen);
  const std::vector<renderer::Vec3f> no_fixed_light(receivers.size());
  const auto observations =
      with_noise(inverse::observe_target(target, {importance.chosen, importance.probability}, no_fixed_light), target,
                 importance.chosen);
  inverse::BakeResult bake = inverse::bake(stage.tracer, receivers, stage.grid,
                                           {.samples = 256, .bounces = -1, .seed = 0, .materials = "gltf"});
  return {weighted_by_noise(observations, bake.cache.indirect_relative_error), std::move(bake), receivers.samples};
}

MatrixXd weighted(const Observed& observed, const std::vector<Column>& columns) {
  MatrixXd a(observed.observations.wanted.rows(), Eigen::Index(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    a.col(Eigen::Index(j)) = observed.observations.sqrt_weight.cwiseProduct(columns[j].col(kGreen));
  }
  return a;
}

MatrixXd weighted_target(const Observed& observed) {
  return observed.observations.sqrt_weight.asDiagonal() * observed.observations.wanted;
}

std::vector<Column> grid_columns(const inverse::LightResponse& response) {
  std::vector<Column> columns;
  for (std::size_t j = 0; j < response.grid().positions.size(); ++j) columns.push_back(response.grid_column(j));
  return columns;
}

// Brightest first.
std::vector<std::size_t> by_intensity(const VectorXd& intensity) {
  std::vector<std::size_t> order(std::size_t(intensity.size()));
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return intensity[Eigen::Index(i)] > intensity[Eigen::Index(j)];
  });
  return order;
}

// On a lattice twice as fine, around the brightest of the grid's lights, which come first.
Round lights_around(const inverse::LightResponse& response, const VectorXd& intensity) {
  const inverse::LightGrid& grid = response.grid();
  std::set<std::array<int, 3>> taken;
  Round round;
  std::vector<double> found;
  for (const std::size_t light : by_intensity(intensity)) {
    const renderer::Vec3f at = grid.positions[light] - grid.origin;
    for (int k = 0; k < 27 && round.columns.size() < kManyColumns; ++k) {
      const std::array<int, 3> step{(k + 1) % 3 - 1, (k / 3 + 1) % 3 - 1, (k / 9 + 1) % 3 - 1};  // none first
      std::array<int, 3> node{};
      Eigen::Vector3d position;
      for (int axis = 0; axis < 3; ++axis) {
        node[axis] = 2 * int(std::lround(at[axis] / grid.spacing[axis])) + step[axis];
        position[axis] = double(grid.origin[axis]) + 0.5 * double(node[axis]) * double(grid.spacing[axis]);
      }
      if (!taken.insert(node).second) continue;
      round.columns.push_back(response.evaluate(position, inverse::Evaluation::kTracedVisibility));
      found.push_back(k == 0 ? intensity[Eigen::Index(light)] : 0);
    }
  }
  round.found = Eigen::Map<const VectorXd>(found.data(), Eigen::Index(found.size()));
  return round;
}

MatrixXd every_fourth_row(const MatrixXd& a) { return a(Eigen::seq(0, Eigen::last, 4), Eigen::all); }

std::vector<NnlsCase> variations(const MatrixXd& a, const MatrixXd& b, const VectorXd& found) {
  std::mt19937 random(1);
  const VectorXd column_factors = wild_factors(a.cols(), 6, random), row_factors = wild_factors(a.rows(), 2, random);
  const MatrixXd start = found.replicate(1, 3);
  std::vector<NnlsCase> cases{
      {"around lit lights", a, b.col(kGreen), found},
      {"…, three sides", a, b, start},
      {"…, a quarter of rows", every_fourth_row(a), every_fourth_row(b.col(kGreen)), found},
      {"…, wild columns", a * column_factors.asDiagonal(), b.col(kGreen), found.cwiseQuotient(column_factors)}};
  cases.push_back({"…, wild weights", row_factors.asDiagonal() * a, row_factors.asDiagonal() * b.col(kGreen), found});
  return cases;
}

// Broad bumps on a line; b is a mixture of a few others.
MatrixXd bumps(int rows, int columns, double width, double first) {
  return MatrixXd::NullaryExpr(rows, columns, [&](Eigen::Index i, Eigen::Index j) {
    const double d = (double(i) / rows - (double(j) + first) / columns) / width;
    return 1 / (1 + d * d);
  });
}

MatrixXd near_copies(Eigen::Index rows, Eigen::Index columns, std::mt19937& random) {
  MatrixXd a = random_matrix(rows, columns, random).cwiseAbs();
  const VectorXd distance = wild_factors(columns, 8, random) * 1e-8;
  for (Eigen::Index j = columns / 4; j < columns; ++j) {
    a.col(j) = a.col(Eigen::Index(random() % unsigned(columns / 4))) + distance[j] * random_matrix(rows, 1, random);
  }
  return a;
}

MatrixXd with_copies_and_zeros(MatrixXd a) {
  const Eigen::Index third = a.cols() / 3;
  a.middleCols(third, third) = a.leftCols(third);
  a.rightCols(10).setZero();
  return a;
}

}  // namespace

std::vector<NnlsCase> transport_cases(const Stage& stage, SetNumber number, const TargetOptions& options) {
  const Observed observed = observe(stage, number, options);
  const inverse::LightResponse response(stage.tracer, observed.samples, observed.bake.cache);
  const MatrixXd b = weighted_target(observed), coarse = weighted(observed, grid_columns(response));
  const VectorXd found = solution_of(coarse, b.col(kGreen));
  const Round round = lights_around(response, found);
  std::mt19937 random(2);
  std::vector<NnlsCase> cases{with_start("grid lights", coarse, b.col(kGreen), random),
                              with_start("…, three sides", coarse, b, random)};
  for (NnlsCase& variation : variations(weighted(observed, round.columns), b, round.found)) {
    cases.push_back(std::move(variation));
  }
  return cases;
}

std::vector<NnlsCase> synthetic_cases(unsigned seed) {
  std::mt19937 random(seed);
  const MatrixXd line = bumps(1000, 2000, 0.05, 0.5);
  const MatrixXd few = bumps(1000, 6, 0.05, 0.37) * random_matrix(6, 3, random).cwiseAbs();
  const MatrixXd low_rank = random_matrix(1000, 50, random).cwiseAbs() * random_matrix(50, 2000, random).cwiseAbs();
  std::vector<NnlsCase> cases;
  cases.push_back(with_start("bumps, noise", line, few + 0.01 * random_matrix(1000, 3, random), random));
  cases.push_back(with_start("bumps, no noise", line, few, random));
  cases.push_back(with_start("near copies", near_copies(600, 1200, random), random_matrix(600, 1, random), random));
  cases.push_back(with_start("copies and zeros", with_copies_and_zeros(random_matrix(800, 900, random)),
                             random_matrix(800, 1, random), random));
  cases.push_back(with_start("low rank", low_rank, low_rank.leftCols(20).rowwise().sum(), random));
  cases.push_back(with_start("Gaussian", random_matrix(1000, 500, random), random_matrix(1000, 3, random), random));
  cases.push_back(
      with_start("Gaussian, wide", random_matrix(400, 1200, random), random_matrix(400, 1, random), random));
  return cases;
}

}  // namespace chiaro::benchmarks

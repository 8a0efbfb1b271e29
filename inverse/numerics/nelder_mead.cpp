// The downhill simplex method.
// Sources: J. A. Nelder, R. Mead, A simplex method for function minimization, Computer Journal 7, 1965;
// F. Gao, L. Han, Implementing the Nelder–Mead simplex algorithm with adaptive parameters, Computational Optimization
// and Applications 51, 2012: the steps are those of its section 1, the coefficients equation (4.1).

#include "inverse/numerics/nelder_mead.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace chiaro::inverse::numerics {
namespace {

using Eigen::VectorXd;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRestartScale = 0.1;

struct Vertex {
  VectorXd x;  // over the free parameters
  double value = kInfinity;
};
using Simplex = std::vector<Vertex>;  // best first

// What is minimised, over the parameters that the bounds leave free.
struct Objective {
  const std::function<double(const VectorXd&)>& f;
  VectorXd full;          // all parameters; the fixed ones keep their values
  std::vector<int> free;  // indices into `full`
  VectorXd step, lower, upper;
  int evaluations_left;

  VectorXd project(const VectorXd& x) const { return x.cwiseMax(lower).cwiseMin(upper); }

  VectorXd expand(const VectorXd& x) const {
    VectorXd all = full;
    for (std::size_t i = 0; i < free.size(); ++i) all[free[i]] = x[Eigen::Index(i)];
    return all;
  }

  Vertex evaluate(const VectorXd& wanted) {
    Vertex vertex{project(wanted), kInfinity};
    if (evaluations_left <= 0) return vertex;
    --evaluations_left;
    const double value = f(expand(vertex.x));
    if (std::isfinite(value)) vertex.value = value;
    return vertex;
  }
};

// Gao & Han, eq. (4.1). In one dimension as in two, where they are the classic ones.
struct Coefficients {
  explicit Coefficients(double n)
      : expansion(1 + 2 / std::max(n, 2.0)),
        contraction(0.75 - 0.5 / std::max(n, 2.0)),
        shrinkage(1 - 1 / std::max(n, 2.0)) {}
  double reflection = 1;
  double expansion, contraction, shrinkage;
};

void sort_by_value(Simplex& simplex) {
  std::stable_sort(simplex.begin(), simplex.end(), [](const Vertex& a, const Vertex& b) { return a.value < b.value; });
}

Simplex make_simplex(Objective& objective, const Vertex& first, double scale) {
  Simplex simplex{first};
  for (Eigen::Index i = 0; i < first.x.size(); ++i) {
    const double edge = scale * objective.step[i];
    const double above = std::min(edge, objective.upper[i] - first.x[i]);
    const double below = std::min(edge, first.x[i] - objective.lower[i]);
    VectorXd x = first.x;
    x[i] += above >= below ? above : -below;
    simplex.push_back(objective.evaluate(x));
  }
  sort_by_value(simplex);
  return simplex;
}

// Every vertex is so near to the best that none lies between.
bool collapsed(const Simplex& simplex) {
  const VectorXd& best = simplex.front().x;
  const double epsilon = 4 * std::numeric_limits<double>::epsilon();
  return std::all_of(simplex.begin(), simplex.end(), [&](const Vertex& vertex) {
    return ((vertex.x - best).array().abs() <= epsilon * best.array().abs()).all();
  });
}

bool has_converged(const Simplex& simplex, const Objective& objective, const NelderMeadOptions& options) {
  const Vertex &best = simplex.front(), &worst = simplex.back();
  if (!std::isfinite(best.value)) return false;
  if (collapsed(simplex)) return true;
  if (!(worst.value - best.value <= options.value_tolerance * (std::abs(best.value) + 1e-30))) return false;
  return std::all_of(simplex.begin(), simplex.end(), [&](const Vertex& vertex) {
    return ((vertex.x - best.x).array().abs() <= options.parameter_tolerance * objective.step.array()).all();
  });
}

VectorXd centroid_without_worst(const Simplex& simplex) {
  VectorXd sum = VectorXd::Zero(simplex[0].x.size());
  for (std::size_t i = 0; i + 1 < simplex.size(); ++i) sum += simplex[i].x;
  return sum / double(simplex.size() - 1);
}

void shrink(Simplex& simplex, Objective& objective, double shrinkage) {
  const VectorXd best = simplex.front().x;
  for (std::size_t i = 1; i < simplex.size(); ++i) {
    simplex[i] = objective.evaluate(best + shrinkage * (simplex[i].x - best));
  }
}

// One step. Moves are measured from the centroid of all but the worst vertex along the way from the worst to it.
void improve(Simplex& simplex, Objective& objective, const Coefficients& by) {
  Vertex& worst = simplex.back();
  const VectorXd centroid = centroid_without_worst(simplex), way = centroid - worst.x;
  const Vertex reflected = objective.evaluate(centroid + by.reflection * way);
  const double second_worst = simplex[simplex.size() - 2].value;
  if (reflected.value < simplex.front().value) {
    const Vertex expanded = objective.evaluate(centroid + by.expansion * way);
    worst = expanded.value < reflected.value ? expanded : reflected;
  } else if (reflected.value < second_worst) {
    worst = reflected;
  } else {
    const bool outside = reflected.value < worst.value;
    const Vertex contracted = objective.evaluate(centroid + (outside ? by.contraction : -by.contraction) * way);
    const bool accepted = outside ? contracted.value <= reflected.value : contracted.value < worst.value;
    if (accepted) {
      worst = contracted;
    } else {
      shrink(simplex, objective, by.shrinkage);
    }
  }
  sort_by_value(simplex);
}

// From `best`, which it replaces by what it finds. Returns whether it converged before the evaluations ran out.
bool descend(Vertex& best, Objective& objective, double scale, const NelderMeadOptions& options) {
  const Coefficients coefficients(double(best.x.size()));
  Simplex simplex = make_simplex(objective, best, scale);
  bool converged = has_converged(simplex, objective, options);
  while (!converged && objective.evaluations_left > 0 && !(options.stop && options.stop())) {
    improve(simplex, objective, coefficients);
    converged = has_converged(simplex, objective, options);
  }
  best = simplex.front();
  return converged;
}

void check_arguments(const VectorXd& x0, const VectorXd& step, const VectorXd& lower, const VectorXd& upper) {
  const Eigen::Index n = x0.size();
  if (step.size() != n || lower.size() != n || upper.size() != n) {
    throw std::invalid_argument("nelder_mead: one step and two bounds per parameter are needed");
  }
  if (!x0.allFinite() || !step.allFinite() || !(step.array() > 0).all() || !(lower.array() <= upper.array()).all()) {
    throw std::invalid_argument("nelder_mead: finite parameters, steps > 0 and lower <= upper are needed");
  }
}

VectorXd select(const VectorXd& all, const std::vector<int>& indices) {
  VectorXd selected(Eigen::Index(indices.size()));
  for (std::size_t i = 0; i < indices.size(); ++i) selected[Eigen::Index(i)] = all[indices[i]];
  return selected;
}

}  // namespace

NelderMeadResult nelder_mead(const std::function<double(const VectorXd&)>& f, const VectorXd& x0, const VectorXd& step,
                             const VectorXd& lower, const VectorXd& upper, const NelderMeadOptions& options) {
  check_arguments(x0, step, lower, upper);
  std::vector<int> free;
  for (int i = 0; i < x0.size(); ++i) {
    if (lower[i] < upper[i]) free.push_back(i);
  }
  const int budget = std::max(1, options.max_evaluations);
  Objective objective{
      f,     x0.cwiseMax(lower).cwiseMin(upper), free, select(step, free), select(lower, free), select(upper, free),
      budget};
  Vertex best = objective.evaluate(select(objective.full, free));
  bool converged = free.empty() && std::isfinite(best.value);
  if (!free.empty()) {
    converged = descend(best, objective, 1, options);
    if (converged && options.restart) converged = descend(best, objective, kRestartScale, options);
  }
  return {objective.expand(best.x), best.value, budget - objective.evaluations_left, converged};
}

}  // namespace chiaro::inverse::numerics

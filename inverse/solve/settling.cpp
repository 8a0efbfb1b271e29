#include "inverse/solve/settling.h"

#include "inverse/numerics/chosen_from.h"
#include "inverse/solve/instrumental_fit.h"
#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

constexpr double kNear = 1e-3;  // of the region's diagonal

// Light by bounces at all receivers, at 1 cd.
std::vector<Column> unity_indirect_of_all(const Settling& with, const LightEstimates& lights,
                                          const std::vector<const std::vector<Vec3f>*>& traced) {
  std::vector<Column> indirect = direct_columns(with.all, lights);
  for (std::size_t j = 0; j < lights.size(); ++j) {
    indirect[j] = unity_indirect(column_of(*traced[j]), indirect[j], lights[j].intensity);
  }
  return indirect;
}

}  // namespace

Settling::Settling(const SolveProblem& problem, const DirectlyLit& all_receivers, const Eigen::VectorXd& brightness,
                   std::size_t receivers, std::size_t held_lights)
    : target(problem.target),
      all(all_receivers),
      draw(draw_brightest_and_evenly(target, brightness, receivers)),
      some(problem.tracer, all.response(), numerics::chosen_from(target.receivers.samples, draw.chosen)),
      held(held_lights),
      near(kNear * double(all.response().grid().region.diagonal())) {}

std::vector<Column> direct_columns(const DirectlyLit& receivers, const LightEstimates& lights) {
  return evaluate_columns(receivers.response(), lights, Evaluation::kTracedVisibility);
}

FreeLights free_lights(const Settling& with, const LightEstimates& lights, const FreshTrace& drawn) {
  FreeLights free;
  free.traced.assign(lights.begin() + std::ptrdiff_t(with.held), lights.end());
  free.now = free.traced;
  const std::vector<Column> direct = direct_columns(with.some, free.now);
  for (std::size_t j = 0; j < free.now.size(); ++j) {
    free.brought.push_back(column_of(drawn.of_light[with.held + j]));
    free.indirect_traced.push_back(unity_indirect(free.brought[j], direct[j], free.now[j].intensity));
    free.number.push_back(with.held + j);
  }
  free.indirect = free.indirect_traced;
  return free;
}

Observations wanted_of(const Settling& with, const FreeLights& free, const FreshTrace& drawn) {
  Observations observations = in_mean_weights(observe_target(with.target, with.draw, drawn.all.value));
  for (const Column& brought : free.brought) observations.wanted += brought;
  if (with.held > 0) return with_capped_weights(observations);
  if (with.target.standard_error.empty()) return observations;
  return weighted_by_noise(with_noise(std::move(observations), with.target, with.draw.chosen), 0);
}

void carry_along(const Settling& with, const FreshTrace& before, const FreshTrace& now, FreeLights& free) {
  std::vector<const std::vector<Vec3f>*> traced_before, traced_now;
  for (std::size_t j = 0; j < free.now.size(); ++j) {
    traced_before.push_back(&before.of_light[free.number[j]]);
    traced_now.push_back(&now.of_light[with.held + j]);
  }
  const std::vector<Column> there = unity_indirect_of_all(with, free.traced, traced_before);
  free.carried = unity_indirect_of_all(with, free.now, traced_now);
  for (std::size_t j = 0; j < free.now.size(); ++j) {
    Column& change = free.carried[j];
    for (int c = 0; c < 3; ++c) {
      // Of a channel that is dark in one of them nothing is known.
      const bool shines = free.traced[j].intensity[c] > 0 && free.now[j].intensity[c] > 0;
      change.col(c) = shines ? Eigen::VectorXd(change.col(c) - there[j].col(c)) : Eigen::VectorXd::Zero(change.rows());
    }
    free.indirect[j] = free.indirect_traced[j] + change(with.draw.chosen, Eigen::all);
  }
}

void follow(const Settling& with, const FreeLights& free, FreshTrace& traced) {
  std::vector<Vec3f>& illumination = traced.all.value;
  Column change = Column::Zero(Eigen::Index(illumination.size()), 3);
  for (std::size_t j = with.held; j < traced.of_light.size(); ++j) change -= column_of(traced.of_light[j]);
  const std::vector<Column> before = direct_columns(with.all, free.traced), now = direct_columns(with.all, free.now);
  for (std::size_t j = 0; j < free.now.size(); ++j) {
    const Column brought = column_of(traced.of_light[free.number[j]]);
    Column indirect = unity_indirect(brought, before[j], free.traced[j].intensity);
    if (!free.carried.empty()) indirect += free.carried[j];
    change += (now[j] + indirect) * free.now[j].intensity.matrix().asDiagonal();
  }
  for (std::size_t i = 0; i < illumination.size(); ++i) {
    illumination[i] = max(illumination[i] + to_vec3f(change.row(Eigen::Index(i)).transpose()), Vec3f{});
  }
}

LightEstimates joined(const Settling& with, const LightEstimates& lights, const FreeLights& free) {
  LightEstimates all(lights.begin(), lights.begin() + std::ptrdiff_t(with.held));
  all.insert(all.end(), free.now.begin(), free.now.end());
  return all;
}

}  // namespace chiaro::inverse

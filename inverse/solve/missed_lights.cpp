#include "inverse/solve/missed_lights.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "inverse/solve/insertion.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

constexpr double kGain = 0.01;   // of what is left, squared, that each of them explains at least …
constexpr double kBegin = 0.3;   // … of which this part where it is led from, …
constexpr int kLed = 4;          // … of the best …
constexpr double kApart = 0.03;  // … so far from all others, of the region's diagonal
constexpr double kFirstStep = 0.04, kLastStep = 0.002;  // of the region's diagonal
constexpr int kTurns = 3;

// A light, and the squared error that it takes off what is left.
struct Led {
  LightEstimate light;
  double gain = 0;
};

Led fitted_at(const LightResponse& response, const Observations& left, const Eigen::Vector3d& place) {
  Led led{{place, Eigen::Array3d::Zero()}};
  led.gain = fit_intensity(left, response.direct(place), led.light);
  return led;
}

bool explains_more(const Led& a, const Led& b) { return a.gain > b.gain; }

std::vector<Eigen::Vector3d> places_around(const AllowedPlaces& allowed, const Eigen::Vector3d& place, double step) {
  std::vector<Eigen::Vector3d> places;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double way : {-step, step}) {
      if (const auto there = allowed.nearest(place + way * Eigen::Vector3d::Unit(axis))) places.push_back(*there);
    }
  }
  return places;
}

// Along the axes, by steps that become smaller, as long as the light explains more.
Led lead(const SettlingBench& bench, const Observations& left, const Eigen::Vector3d& from) {
  const double diagonal = double(bench.response.grid().region.diagonal());
  Led led = fitted_at(bench.response, left, from);
  for (double step = kFirstStep * diagonal; step > kLastStep * diagonal && !bench.stops();) {
    const std::vector<Eigen::Vector3d> places = places_around(bench.response.places(), led.light.position, step);
    std::vector<Led> tried(places.size());
    renderer::parallel_for(places.size(),
                           [&](std::size_t k) { tried[k] = fitted_at(bench.response, left, places[k]); });
    const auto best = std::min_element(tried.begin(), tried.end(), explains_more);
    if (best != tried.end() && best->gain > led.gain) {
      led = *best;
    } else {
      step /= 2;
    }
  }
  return led;
}

double apart_in(const SettlingBench& bench) { return kApart * double(bench.response.grid().region.diagonal()); }

bool is_apart(const LightEstimates& lights, const Eigen::Vector3d& place, double distance) {
  return std::all_of(lights.begin(), lights.end(),
                     [&](const LightEstimate& light) { return (light.position - place).norm() >= distance; });
}

// Led from the best of these places, if there are any among the most promising: most often there are none. No nearer to
// `others` than it could be one of them.
std::optional<Led> lead_from(const SettlingBench& bench, const Observations& left,
                             const std::vector<Eigen::Vector3d>& places, LightEstimates others, double least) {
  if (!propose_directly_lit(bench.response, left, places, kBegin * least)) return std::nullopt;
  std::vector<Led> tried(places.size());
  renderer::parallel_for(places.size(), [&](std::size_t k) {
    if (!bench.stops()) tried[k] = fitted_at(bench.response, left, places[k]);
  });
  if (bench.stops()) return std::nullopt;
  std::stable_sort(tried.begin(), tried.end(), explains_more);
  const double apart = apart_in(bench);
  std::optional<Led> best;
  int led = 0;
  for (const Led& from : tried) {
    if (led == kLed || from.gain < kBegin * least) break;
    if (!is_apart(others, from.light.position, apart)) continue;
    const Led to = lead(bench, left, from.light.position);
    ++led;
    if (!is_apart(others, to.light.position, apart)) continue;
    others.push_back(to.light);
    if (to.gain >= std::max(least, best ? best->gain : 0)) best = to;
  }
  return best;
}

// Each beside the others, where these have come to, and apart from them and from those that stay.
void lead_in_turn(const SettlingBench& bench, const Observations& left, const LightEstimates& staying,
                  LightEstimates& lights) {
  for (int turn = 0; turn < kTurns; ++turn) {
    for (std::size_t j = 0; j < lights.size() && !bench.stops(); ++j) {
      LightEstimates others = lights;
      others.erase(others.begin() + std::ptrdiff_t(j));
      const LightEstimate led = lead(bench, less(left, bench.response, others), lights[j].position).light;
      others.insert(others.end(), staying.begin(), staying.end());
      if (is_apart(others, led.position, apart_in(bench))) lights[j] = led;
    }
  }
}

}  // namespace

LightEstimates find_missed_lights(const SettlingBench& bench, const std::vector<Column>& indirect,
                                  const LightEstimates& lights, const std::vector<Eigen::Vector3d>& places,
                                  std::size_t most) {
  const Column illumination = bench.illumination(indirect, lights);
  Observations left = bench.as_most_say(illumination);
  left.wanted -= illumination;
  const double least = kGain * std::pow((left.sqrt_weight.asDiagonal() * left.wanted).norm(), 2);
  LightEstimates missed;
  while (missed.size() < most && !bench.stops()) {
    LightEstimates others = lights;
    others.insert(others.end(), missed.begin(), missed.end());
    const auto led = lead_from(bench, less(left, bench.response, missed), places, std::move(others), least);
    if (!led) break;
    missed.push_back(led->light);
    if (missed.size() > 1) lead_in_turn(bench, left, lights, missed);
  }
  std::erase_if(missed, is_dark);
  return missed;
}

}  // namespace chiaro::inverse

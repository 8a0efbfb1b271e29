#include "inverse/solve/carry_along.h"

#include <utility>

namespace chiaro::inverse {
namespace {

constexpr double kNoisier = 1.1;  // times the error: what was carried along is mostly noise

double error_of(const SettlingBench& bench, const FreeLights& free) {
  return relative_error(bench.observations, bench.illumination(free.indirect, free.now));
}

}  // namespace

bool come_along(const SettlingBench& bench, const CarryAlong& carry_along, FreeLights& free) {
  FreeLights carried = free;
  carry_along(carried);
  if (error_of(bench, carried) > kNoisier * error_of(bench, free)) return false;
  free = std::move(carried);
  return true;
}

}  // namespace chiaro::inverse

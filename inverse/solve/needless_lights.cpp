#include "inverse/solve/needless_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace chiaro::inverse {
namespace {

constexpr double kDoubtful = 1.8;       // of the half width of its interval: a light so weak may be there for nothing
constexpr double kHardlySeen = 0.02;    // of the target's norm: the same of the weakest …
constexpr std::size_t kMostWeak = 4;    // … few
constexpr double kGain = 0.01;          // of the squared error: what a light must explain …
constexpr double kSignificant = 3;      // … and standard errors
constexpr double kNearlyAsGood = 0.08;  // of the squared error, or less: what fewer lights leave more

// Those whose intensity may as well be none, and the weakest few of those that light so little that they may make good
// what is wrong with the others; in their order.
std::vector<std::size_t> doubtful_ones(const SettlingBench& bench, const FreeLights& free,
                                       const LightIntervals& intervals) {
  std::vector<std::pair<double, std::size_t>> by_share;
  for (std::size_t j = 0; j < free.now.size(); ++j) {
    by_share.emplace_back(bench.norm(free.brought[j]) / bench.observations.target_norm, j);
  }
  std::sort(by_share.begin(), by_share.end());
  std::vector<std::size_t> doubtful;
  for (std::size_t k = 0; k < by_share.size(); ++k) {
    const auto [share, j] = by_share[k];
    const bool may_be_none = (free.now[j].intensity < kDoubtful * intervals.lights[j].intensity).all();
    if (may_be_none || (k < kMostWeak && share < kHardlySeen)) doubtful.push_back(j);
  }
  std::sort(doubtful.begin(), doubtful.end());
  return doubtful;
}

// Tries of fewer lights than there are.
class Tries {
 public:
  Tries(const SettlingBench& bench, const CarryAlong& carry_along, FreeLights& free)
      : bench_(bench), carry_along_(carry_along), free_(free), all_(bench.illumination(free.indirect, free.now)) {}

  // True: these went, as the others do as well.
  bool go_without(const std::vector<std::size_t>& gone) {
    if (gone.size() == free_.now.size()) return false;
    FreeLights rest = without(free_, gone);
    FreeLights fewer = rest;
    bench_.descend(fewer.indirect, fewer.now);
    const Column left = bench_.illumination(fewer.indirect, fewer.now);
    if (take(fewer, left)) return true;
    // Beside a shadow's edge the others may have come down elsewhere, and worse.
    if (take(rest, bench_.illumination(rest.indirect, rest.now))) return true;
    const double error = relative_error(bench_.observations, left);
    if (error < nearest_error_) nearest_error_ = error, nearest_ = std::move(fewer);
    return false;
  }

  // The same of those whose others came nearest, with light by bounces of where these have come to.
  bool go_carried_along() {
    const double enough = std::sqrt(1 + kNearlyAsGood) * relative_error(bench_.observations, all_);
    if (!carry_along_ || !nearest_ || nearest_error_ > enough) return false;
    carry_along_(*nearest_);
    return take(*nearest_, bench_.illumination(nearest_->indirect, nearest_->now));
  }

 private:
  // Those that do as well; left: what they bring.
  bool take(FreeLights& fewer, const Column& left) {
    if (bench_.explains_more(all_, left, kGain, kSignificant)) return false;
    if (bench_.explains_more_to_most(all_, left, kGain, kSignificant)) return false;
    free_ = std::move(fewer);
    return true;
  }

  const SettlingBench& bench_;
  const CarryAlong& carry_along_;
  FreeLights& free_;
  const Column all_;  // what all of them bring
  std::optional<FreeLights> nearest_{};
  double nearest_error_ = std::numeric_limits<double>::infinity();
};

// Several may make good together what is wrong with the others, so that each of them seems to be needed.
bool remove_some(const SettlingBench& bench, const CarryAlong& carry_along, const LightIntervals& intervals,
                 FreeLights& free) {
  const std::vector<std::size_t> doubtful = doubtful_ones(bench, free, intervals);
  Tries tries(bench, carry_along, free);
  if (doubtful.size() > 1 && tries.go_without(doubtful)) return true;
  const bool went = std::any_of(doubtful.begin(), doubtful.end(),
                                [&](std::size_t j) { return !bench.stops() && tries.go_without({j}); });
  return went || (!bench.stops() && tries.go_carried_along());
}

}  // namespace

LightIntervals remove_needless(const SettlingBench& bench, const CarryAlong& carry_along, FreeLights& free) {
  LightIntervals intervals = bench.intervals(free.indirect, free.now);
  while (free.now.size() > 1 && !bench.stops() && remove_some(bench, carry_along, intervals, free)) {
    intervals = bench.intervals(free.indirect, free.now);
  }
  return intervals;
}

}  // namespace chiaro::inverse

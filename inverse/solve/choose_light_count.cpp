#include "inverse/solve/choose_light_count.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "inverse/solve/insertion.h"
#include "inverse/solve/known_corrections.h"
#include "inverse/solve/pair_of_lights.h"
#include "inverse/solve/sets_without_one.h"
#include "inverse/solve/split_lights.h"
#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/control.h"
#include "renderer/core/sampler.h"
#include "renderer/core/seconds_since.h"

namespace chiaro::inverse {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMostCuts = 16;     // sizes of the light tree's cuts that are refined
constexpr int kCutsAtOnce = 2;    // in turn, from the smallest …
constexpr int kIdleCuts = 2;      // … until so many in a row explain no more
constexpr double kNoise = 2;      // times the noise, or less: there is nothing but noise and the errors of transport
constexpr double kNearNoise = 5;  // times the noise, or less: little else is left
constexpr double kKneeOfLimited = 1.02;  // in place of kKnee, where lights are as bright as they may be
constexpr double kNoiseMargin = 1.02;    // an error this close to the noise is explained
constexpr double kStill = 5e-4;          // of the region's diagonal: indirect light hardly changes
constexpr double kRounding = 1e-4;       // an error this small is that of floats, and explained
constexpr int kMany = 32;                // lights: no more than these are sought in order to find few
constexpr int kIdleInsertions = 2;       // insertions in a row that may gain nothing
constexpr std::size_t kMostSplits = 3, kMostPairs = 3;
// Of many starts these tell which to follow.
constexpr JointRefinementOptions kFirstSteps{.max_iterations = 4, .function_tolerance = 1e-3};
constexpr std::size_t kFinalists = 2;
// Beyond that descents go on from one shadow edge to the next.
constexpr JointRefinementOptions kSearching{.max_iterations = 15, .function_tolerance = 1e-3};
constexpr JointRefinementOptions kToTheEnd{.max_iterations = 60, .function_tolerance = 1e-5};
constexpr int kMostRounds = 3;                 // of growth after the number of lights was told
constexpr std::size_t kMostParents = 3;        // sets with one light less, descended to the end
constexpr double kSeen = 3, kSeenInCrowd = 1;  // standard errors of held-out residuals
constexpr std::size_t kCrowd = 12;             // lights or more: some are exchanged …
constexpr std::size_t kMostExchanged = 4;
constexpr double kSurelyNoise = 1.25;  // … unless they leave so many times the noise, or less …
constexpr double kClearlyLess = 0.99;  // … again and again, while that makes the error so much less
constexpr std::size_t kGoesBack = 2;   // lights less than a search that goes on began with
constexpr int kShakes = 8;             // further descents of a set that is to be refused …
constexpr float kShaken = 0.03F;       // … from as far away at most, of the region's diagonal

class Search {
 public:
  Search(const LightResponse& response, const Observations& observations, const LightTree& tree,
         const LightCountOptions& options)
      : response_(response), observations_(observations), tree_(tree), options_(options), start_(Clock::now()) {
    const double still = kStill * double(response.grid().region.diagonal());
    if (options.exact != nullptr) corrections_.emplace(*options.exact, response, still);
    if (options.held_out != nullptr) held_out_.emplace(*options.held_out, still);
  }

  LightCountResult run() {
    if (options_.earlier.empty()) {
      begin();
      tell_count();
      if (exchange_lights()) tell_count();
    }
    for (const LightEstimates& lights : options_.earlier) {
      if (best_.size() < 2 || !out_of_time()) consider({lights});
    }
    come_closest_with_fewer();
    return result();
  }

 private:
  struct Candidate {
    LightEstimates lights;
    double error = std::numeric_limits<double>::infinity();
    Eigen::VectorXd held_out{};  // residuals; empty: not evaluated
  };

  void begin() {
    for (const LightEstimates& lights : options_.begun.sets) {
      if (lights.size() < least_sought()) {
        keep_as_it_is(lights);
      } else if (!out_of_time()) {
        consider({lights});
      }
    }
    if (best_.size() > 1) return;
    refine_cuts();
    insert_lights();
  }

  std::size_t least_sought() const { return std::max(options_.begun.lights, kGoesBack + 1) - kGoesBack; }

  int most_lights() const { return options_.exact_lights > 0 ? options_.exact_lights : options_.max_lights; }
  // The best set of few lights is one of more that some of them left.
  int most_searched() const { return std::max(most_lights(), std::min(2 * most_lights() + 2, kMany)); }

  bool out_of_time() {
    out_of_time_ = out_of_time_ || renderer::seconds_since(start_) > options_.seconds_left;
    return out_of_time_;
  }

  std::vector<JointRefinement> refine_all(const std::vector<LightEstimates>& starts,
                                          const JointRefinementOptions& how) {
    return refine_all(observations_, starts, how);
  }

  std::vector<JointRefinement> refine_all(const Observations& observations, const std::vector<LightEstimates>& starts,
                                          const JointRefinementOptions& how) {
    std::vector<JointRefinement> refined(starts.size());
    renderer::parallel_for(starts.size(),
                           [&](std::size_t k) { refined[k] = refine_joint(response_, observations, starts[k], how); });
    refinements_ += int(starts.size());
    return refined;
  }

  // Refines them and keeps the best, if none of its size was better, without the lights that went out.
  void consider(std::vector<LightEstimates> starts, const JointRefinementOptions& how = kSearching) {
    options_.control.stop_if_requested();
    if (starts.size() > kFinalists) starts = best_sets(refine_all(starts, kFirstSteps), kFinalists);
    std::vector<JointRefinement> refined = refine_all(starts, how);
    const auto best = std::min_element(refined.begin(), refined.end(),
                                       [](const auto& a, const auto& b) { return a.error < b.error; });
    if (best != refined.end()) keep_exactly({*best}, how);
  }

  // Between the lights of a grid indirect light is known less well than targets are: sets that leave little are refined
  // again without interpolation.
  void keep_exactly(std::vector<JointRefinement> refined, const JointRefinementOptions& how) {
    const double little = kNearNoise * std::hypot(observations_.noise, options_.transport_error);
    std::vector<LightEstimates> worth_it;
    for (JointRefinement& set : refined) {
      if (corrections_ && set.error < little && !corrections_->has_all(set.lights)) {
        worth_it.push_back(std::move(set.lights));
      } else {
        keep(std::move(set));
      }
    }
    if (worth_it.empty()) return;
    corrections_->correct(worth_it);
    for (JointRefinement& set : refine_all(worth_it, how)) keep(std::move(set));
  }

  // Where the rules of places have them, if they have room for all.
  void keep_as_it_is(LightEstimates lights) {
    std::vector<Eigen::Vector3d> positions = positions_of(lights);
    if (!response_.places().settle(positions)) return;
    for (std::size_t j = 0; j < lights.size(); ++j) lights[j].position = positions[j];
    const std::vector<Column> columns = evaluate_columns(response_, lights, Evaluation::kTracedVisibility);
    const double error = refit_intensities(observations_, columns, lights);
    keep({std::move(lights), error, 0});
  }

  void keep(JointRefinement refined) {
    std::erase_if(refined.lights, is_dark);
    const std::size_t count = refined.lights.size();
    if (count == 0) return;
    if (best_.size() <= count) best_.resize(count + 1);
    if (refined.error < best_[count].error) best_[count] = {std::move(refined.lights), refined.error, {}};
  }

  // Until larger ones explain no more. Those that time does not allow for count as they are.
  void refine_cuts() {
    const int sizes = std::min({tree_.tree.leaf_count, most_searched(), kMostCuts});
    for (int size = 1; size <= sizes && !out_of_time(); size += kCutsAtOnce) {
      std::vector<LightEstimates> cuts;
      for (int k = size; k < std::min(size + kCutsAtOnce, sizes + 1); ++k) {
        cuts.push_back(cut_light_tree(tree_, observations_, {0, k, k}).lights);
      }
      keep_exactly(refine_all(cuts, kSearching), kSearching);
      cuts_are_enough_ = little_is_left() && int(knee()) + kIdleCuts < size + int(cuts.size());
      if (cuts_are_enough_) break;
    }
    if (!out_of_time()) return;
    for (int size = 1; size <= sizes; ++size)
      keep_as_it_is(cut_light_tree(tree_, observations_, {0, size, size}).lights);
  }

  bool little_is_left() const { return least_error() <= std::max(kNoise * observations_.noise, kRounding); }

  double least_error() const {
    const auto less = [](const auto& a, const auto& b) { return a.error < b.error; };
    return std::min_element(best_.begin(), best_.end(), less)->error;
  }

  // The smallest size whose error no larger set lowers by more than the knee's factor, nor by more than noise explains.
  std::size_t knee() const {
    const double least = least_error(), noise = std::max(kNoiseMargin * observations_.noise, kRounding);
    std::size_t size = 1;
    while (size + 1 < best_.size() && !(best_[size].error <= std::max(knee_factor(best_[size]) * least, noise))) ++size;
    return size;
  }

  // Beside lights that are each as bright as they may be a further one explains a part of what is left, and no more.
  double knee_factor(const Candidate& set) const {
    const bool limited = std::any_of(set.lights.begin(), set.lights.end(), [&](const LightEstimate& light) {
      return observations_.rules.limits(light.intensity.maxCoeff());
    });
    return limited ? kKneeOfLimited : kKnee;
  }

  const Eigen::VectorXd& held_out_residuals(Candidate& candidate) {
    if (candidate.held_out.size() == 0) candidate.held_out = held_out_->residuals(candidate.lights);
    return candidate.held_out;
  }

  // Where little more than noise is left a fit has no more to tell: from the knee on, by as many lights as held-out
  // receivers clearly see. Of many lights each does little: one too many goes more easily as lights settle than one too
  // few comes.
  std::size_t best_size() {
    std::size_t size = knee();
    if (!held_out_ || least_error() > kNearNoise * observations_.noise) return size;
    for (std::size_t larger = size + 1; larger < best_.size(); ++larger) {
      if (!(best_[larger].error < best_[size].error)) continue;
      const double clearly = size < kCrowd ? kSeen : kSeenInCrowd;
      if (clearly_smaller(held_out_residuals(best_[size]), held_out_residuals(best_[larger]), clearly)) size = larger;
    }
    return size;
  }

  void consider_one_more(const LightEstimates& lights) {
    std::vector<LightEstimates> starts;
    for (Split& split : propose_splits(response_, observations_, lights, kMostSplits)) {
      starts.push_back(std::move(split.lights));
    }
    for (LightEstimates& pair : propose_pairs(response_, observations_, lights, kMostPairs)) {
      starts.push_back(std::move(pair));
    }
    for (const LightEstimate& inserted : propose_insertions(response_, observations_, lights)) {
      starts.push_back(lights);
      starts.back().push_back(inserted);
    }
    consider(starts);
  }

  void insert_lights() {
    if (best_.size() < 2) consider_one_more({});
    int idle = cuts_are_enough_ ? 1 : 0;
    for (std::size_t size = best_size(); idle < kIdleInsertions && int(size) < most_searched() && !out_of_time();
         ++size) {
      if (size >= best_.size() || best_[size].lights.empty()) break;
      const std::size_t before = best_size();
      const double error = best_[before].error;
      if (error <= observations_.noise * kNoiseMargin && int(size) >= options_.exact_lights) break;
      consider_one_more(best_[size].lights);
      const bool gained = best_size() > before ||
                          (best_.size() > size + 1 && best_[size + 1].error * knee_factor(best_[before]) < error);
      idle = gained ? 0 : idle + 1;
    }
  }

  // From the largest set down: without each light in turn, intensities refitted, the best of them refined.
  void eliminate_lights() {
    for (std::size_t size = best_.size() - 1; size > least_sought() && !out_of_time(); --size) {
      if (!best_[size].lights.empty()) consider(sets_without_one(response_, observations_, best_[size].lights, 1));
    }
  }

  void tell_count() {
    eliminate_lights();
    confirm_count();
    grow_again();
  }

  // A light may be there only to make good what the descent of the others left undone: with one light less, and down to
  // the end, it may not be missed.
  void confirm_count() {
    if (options_.exact_lights > 0 || best_.size() < 2) return;
    for (std::size_t size = knee(); size < best_size() && !out_of_time(); ++size) shake(size);
    for (std::size_t size = best_size(); size > 1 && !out_of_time(); --size) {
      consider({best_[size].lights}, kToTheEnd);
      std::vector<LightEstimates> smaller =
          sets_without_one(response_, observations_, best_[size].lights, kMostParents);
      if (!best_[size - 1].lights.empty()) smaller.push_back(best_[size - 1].lights);
      consider(smaller);
      if (best_[size - 1].error < kKnee * best_[size].error) consider({best_[size - 1].lights}, kToTheEnd);
      if (best_size() >= size) return;
    }
  }

  // One light more never makes a set worse: where it seems to, it was sought beside other lights than these.
  void grow_again() {
    const auto exactly = std::size_t(std::max(0, options_.exact_lights));
    for (int round = 0; round < kMostRounds && !out_of_time(); ++round) {
      const std::size_t size = exactly > 0 ? exactly - 1 : best_size();
      if (size == 0 || size >= best_.size() || int(size) >= most_searched()) return;
      if (size + 1 < best_.size() && best_[size + 1].error < best_[size].error) return;
      consider_one_more(best_[size].lights);
      if (exactly > 0 || best_size() == size) return;
      confirm_count();
    }
  }

  // Of many lights some stand where insertion happened to leave them: each of those that are missed least goes in turn,
  // and what is proposed beside the others takes its place. True: that explained more.
  bool exchange_lights() {
    bool explains_more = false;
    for (int round = 0; round < kMostRounds && !out_of_time(); ++round) {
      const std::size_t size = options_.exact_lights > 0 ? std::size_t(options_.exact_lights) : best_size();
      if (size < kCrowd || size >= best_.size() || best_[size].lights.empty()) break;
      const double error = best_[size].error;
      if (error <= kSurelyNoise * observations_.noise) break;
      for (const LightEstimates& others :
           sets_without_one(response_, observations_, best_[size].lights, kMostExchanged)) {
        if (!out_of_time()) consider_one_more(others);
      }
      if (int(size) < most_searched()) consider_one_more(best_[size].lights);
      if (!(best_[size].error < kClearlyLess * error) && best_size() <= size) break;
      explains_more = true;
    }
    return explains_more;
  }

  // Descents of too few lights and of lights that hang on a shadow's edge look alike, until they start elsewhere.
  void shake(std::size_t size) {
    const LightEstimates& lights = best_[size].lights;
    if (lights.empty()) return;
    const float far = kShaken * response_.grid().region.diagonal();
    std::vector<LightEstimates> starts(kShakes, lights);
    for (std::size_t k = 0; k < starts.size(); ++k) {
      renderer::Sampler sampler(size, 0, std::uint32_t(k));
      for (LightEstimate& light : starts[k]) {
        const Vec3f at = to_vec3f(light.position);
        const Vec3f place = random_position({at - Vec3f{far, far, far}, at + Vec3f{far, far, far}}, sampler);
        light.position = response_.places().nearest(to_eigen(place)).value_or(light.position);
      }
    }
    consider(starts, kToTheEnd);
  }

  // From as many lights as the target takes down, each set by what the objective leaves of the one before.
  void come_closest_with_fewer() {
    if (options_.judged == nullptr || best_.size() < 2) return;
    closest_.resize(best_.size());
    for (std::size_t size = best_size() - 1; size >= least_sought() && !out_of_time(); --size) {
      const LightEstimates& larger = closest(size + 1).lights;
      const bool is_all_there_may_be = int(size) == most_lights();
      std::vector<LightEstimates> starts =
          sets_without_one(response_, *options_.judged, larger, is_all_there_may_be ? kMostParents : std::size_t{1});
      if (!best_[size].lights.empty()) starts.push_back(best_[size].lights);
      for (JointRefinement& set : refine_all(*options_.judged, starts, kSearching)) {
        const bool all_shine = std::none_of(set.lights.begin(), set.lights.end(), is_dark);
        if (!set.lights.empty() && all_shine && set.error < closest_[size].error) {
          closest_[size] = {std::move(set.lights), set.error, {}};
        }
      }
    }
  }

  Candidate& closest(std::size_t size) {
    const bool known = size < closest_.size() && !closest_[size].lights.empty();
    return known ? closest_[size] : best_[size];
  }

  LightCountResult result() {
    LightCountResult r;
    std::size_t size = best_.size() < 2 ? 0 : best_size();
    const std::size_t most = std::min(std::size_t(most_lights()), best_.size() - 1);
    size = options_.exact_lights > 0 ? most : std::min(size, most);
    while (size > 0 && best_[size].lights.empty()) --size;
    if (size > 0) {
      r.lights = closest(size).lights;
      r.error = relative_error(observations_, illumination_of(response_, r.lights));
      if (held_out_) r.held_out = held_out_residuals(closest(size));
    }
    for (std::size_t n = 1; n <= most; ++n) r.sets.push_back(closest(n).lights);
    r.refinements = refinements_;
    r.out_of_time = out_of_time_;
    return r;
  }

  const LightResponse& response_;
  const Observations& observations_;
  const LightTree& tree_;
  LightCountOptions options_;
  Clock::time_point start_;
  std::vector<Candidate> best_{1};    // by number of lights
  std::vector<Candidate> closest_{};  // of fewer lights than the target takes; their errors are the objective's
  std::optional<KnownCorrections> corrections_;
  std::optional<HeldOutSets> held_out_;
  bool cuts_are_enough_ = false;  // larger ones than the best explain no more
  int refinements_ = 0;
  bool out_of_time_ = false;
};

}  // namespace

LightCountResult choose_light_count(const LightResponse& response, const Observations& observations,
                                    const LightTree& tree, const LightCountOptions& options) {
  return Search(response, observations, tree, options).run();
}

}  // namespace chiaro::inverse

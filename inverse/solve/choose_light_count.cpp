#include "inverse/solve/choose_light_count.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "inverse/solve/insertion.h"
#include "renderer/core/seconds_since.h"

namespace chiaro::inverse {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMostCuts = 16;          // sizes of the light tree's cuts that are refined
constexpr double kKnee = 1.25;         // further lights must lower the error by this factor to be believed
constexpr double kNoiseMargin = 1.02;  // an error this close to the noise is explained
constexpr double kRounding = 1e-4;     // an error this small is that of floats, and explained
constexpr int kIdleInsertions = 2;     // insertions in a row that may gain nothing

class Search {
 public:
  Search(const LightResponse& response, const Observations& observations, const LightTree& tree,
         const LightCountOptions& options)
      : response_(response), observations_(observations), tree_(tree), options_(options), start_(Clock::now()) {}

  LightCountResult run() {
    refine_cuts();
    insert_lights();
    eliminate_lights();
    return result();
  }

 private:
  struct Candidate {
    LightEstimates lights;
    double error = std::numeric_limits<double>::infinity();
  };

  int most_lights() const { return options_.exact_lights > 0 ? options_.exact_lights : options_.max_lights; }

  bool out_of_time() {
    out_of_time_ = out_of_time_ || (options_.time_limit > 0 && renderer::seconds_since(start_) > options_.time_limit);
    return out_of_time_;
  }

  // Refines, drops lights that went out, and keeps the set if it is the best of its size.
  void consider(const LightEstimates& start) {
    JointRefinement refined = refine_joint(response_, observations_, start);
    ++refinements_;
    std::erase_if(refined.lights, [](const LightEstimate& l) { return !(l.intensity > 0).any(); });
    const std::size_t count = refined.lights.size();
    if (count == 0) return;
    if (best_.size() <= count) best_.resize(count + 1);
    if (!(refined.error < best_[count].error)) return;
    best_[count] = {std::move(refined.lights), refined.error};
  }

  void refine_cuts() {
    const int sizes = std::min({tree_.tree.leaf_count, most_lights(), kMostCuts});
    for (int size = 1; size <= sizes && !out_of_time(); ++size) {
      consider(cut_light_tree(tree_, observations_, {0, size, size}).lights);
    }
  }

  // The smallest size whose error no larger set lowers by more than the knee's factor, nor by more than noise explains.
  std::size_t knee() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Candidate& c : best_) least = std::min(least, c.error);
    const double enough = std::max({kKnee * least, kNoiseMargin * observations_.noise, kRounding});
    std::size_t size = 1;
    while (size + 1 < best_.size() && !(best_[size].error <= enough)) ++size;
    return size;
  }

  // By value: the best set of its size may change on the way.
  void consider_insertions(LightEstimates lights) {
    for (const LightEstimate& inserted : propose_insertions(response_, observations_, lights)) {
      lights.push_back(inserted);
      consider(lights);
      lights.pop_back();
    }
  }

  void insert_lights() {
    if (best_.size() < 2) consider_insertions({});
    int idle = 0;
    for (std::size_t size = knee(); idle < kIdleInsertions && int(size) < most_lights() && !out_of_time(); ++size) {
      if (size >= best_.size() || best_[size].lights.empty()) break;
      const double before = best_[knee()].error;
      if (before <= observations_.noise * kNoiseMargin && options_.exact_lights == 0) break;
      consider_insertions(best_[size].lights);
      idle = best_.size() > size + 1 && best_[size + 1].error * kKnee < before ? 0 : idle + 1;
    }
  }

  // From the largest set down: without each light in turn, intensities refitted, the best of them refined.
  void eliminate_lights() {
    for (std::size_t size = best_.size() - 1; size > 1 && !out_of_time(); --size) {
      if (best_[size].lights.empty()) continue;
      const LightEstimates& all = best_[size].lights;
      const std::vector<Column> columns = evaluate_columns(response_, all, Evaluation::kTracedVisibility);
      Candidate least;
      for (std::size_t without = 0; without < all.size(); ++without) {
        Candidate c = refitted_without(all, columns, without);
        if (c.error < least.error) least = std::move(c);
      }
      consider(least.lights);
    }
  }

  Candidate refitted_without(LightEstimates lights, std::vector<Column> columns, std::size_t without) const {
    lights.erase(lights.begin() + std::ptrdiff_t(without));
    columns.erase(columns.begin() + std::ptrdiff_t(without));
    const IntensityFit fit = fit_intensities(observations_, columns);
    for (std::size_t j = 0; j < lights.size(); ++j) lights[j].intensity = fit.intensity[j];
    const double error =
        relative_error(observations_, total_illumination(columns, lights, observations_.wanted.rows()));
    return {std::move(lights), error};
  }

  LightCountResult result() const {
    LightCountResult r;
    std::size_t size = best_.size() < 2 ? 0 : knee();
    if (options_.exact_lights > 0) size = std::min(std::size_t(options_.exact_lights), best_.size() - 1);
    if (size > 0) r.lights = best_[size].lights, r.error = best_[size].error;
    for (std::size_t n = 1; n < best_.size(); ++n) r.error_curve.push_back(best_[n].error);
    r.refinements = refinements_;
    r.out_of_time = out_of_time_;
    return r;
  }

  const LightResponse& response_;
  const Observations& observations_;
  const LightTree& tree_;
  LightCountOptions options_;
  Clock::time_point start_;
  std::vector<Candidate> best_{1};  // by number of lights
  int refinements_ = 0;
  bool out_of_time_ = false;
};

}  // namespace

LightCountResult choose_light_count(const LightResponse& response, const Observations& observations,
                                    const LightTree& tree, const LightCountOptions& options) {
  return Search(response, observations, tree, options).run();
}

}  // namespace chiaro::inverse

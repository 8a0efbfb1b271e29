// Insertion off the residual: Boyd, Schiebinger, Recht, The alternating descent conditional gradient method for sparse
// inverse problems, 2017. Count by the knee of the error curve.

#include "inverse/solve/choose_light_count.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>

namespace chiaro::inverse {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMostCuts = 16;          // sizes of the light tree's cuts that are refined
constexpr double kKnee = 1.25;         // further lights must lower the error by this factor to be believed
constexpr double kNoiseMargin = 1.02;  // an error this close to the noise is explained
constexpr double kRounding = 1e-4;     // an error this small is that of floats, and explained
constexpr std::size_t kDarkest = 16;   // receivers in front of which a light is tried …
constexpr float kFarthestInFront = 0.05F, kNearestInFront = 0.0005F;  // … at these parts of the region's diagonal
// Along the normal, and around it at 30 and at 60 degrees.
constexpr Vec3f kDirectionsInFront[] = {
    {0, 0, 1},         {.5F, 0, .87F},     {-.25F, .43F, .87F}, {-.25F, -.43F, .87F}, {.87F, 0, .5F},
    {.43F, .75F, .5F}, {-.43F, .75F, .5F}, {-.87F, 0, .5F},     {-.43F, -.75F, .5F},  {.43F, -.75F, .5F}};
constexpr int kIdleInsertions = 2;  // insertions in a row that may gain nothing

class Search {
 public:
  Search(const LightResponse& response, const ExactIndirect& exact, const Observations& observations,
         const LightTree& tree, const LightCountOptions& options)
      : response_(response),
        exact_(exact),
        observations_(observations),
        tree_(tree),
        options_(options),
        start_(Clock::now()) {}

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
    const double spent = std::chrono::duration<double>(Clock::now() - start_).count();
    out_of_time_ = out_of_time_ || (options_.time_limit > 0 && spent > options_.time_limit);
    return out_of_time_;
  }

  // Refines, drops lights that went out, and keeps the set if it is the best of its size.
  bool consider(const LightEstimates& start) {
    JointRefinement refined = refine_joint(response_, observations_, start);
    ++refinements_;
    std::erase_if(refined.lights, [](const LightEstimate& l) { return !(l.intensity > 0).any(); });
    const std::size_t count = refined.lights.size();
    if (count == 0) return false;
    if (best_.size() <= count) best_.resize(count + 1);
    if (!(refined.error < best_[count].error)) return false;
    best_[count] = {std::move(refined.lights), refined.error};
    return true;
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

  Column illumination_of(const LightEstimates& lights) const {
    const std::vector<Column> columns = evaluate_columns(response_, lights, VisibilitySource::kTraced);
    return total_illumination(columns, lights, observations_.wanted.rows());
  }

  // What a light at this place would explain of the residual, and the intensity that would do it.
  struct Insertion {
    LightEstimate light{Eigen::Vector3d::Zero(), Eigen::Array3d::Zero()};
    double gain = -1;
  };
  Insertion insertion_at(const Eigen::Vector3d& position, const Column& column, const Column& weighted_residual) const {
    const Eigen::VectorXd weight = observations_.sqrt_weight.cwiseAbs2();
    const Eigen::Array3d along = column.cwiseProduct(weighted_residual).colwise().sum().transpose().array().max(0);
    const Eigen::Array3d squared = (weight.asDiagonal() * column).cwiseProduct(column).colwise().sum().transpose();
    return {{position, along / squared.max(1e-300)}, (along.square() / squared.max(1e-300)).sum()};
  }

  // The best of the grid's lights, and the best few places in front of the receivers that lack most light: a light
  // right beside a surface, or inside a fixture, is seen by hardly anything else.
  LightEstimates insertions(const LightEstimates& lights) const {
    const Column residual = observations_.wanted - illumination_of(lights);
    const Column weighted = observations_.sqrt_weight.cwiseAbs2().asDiagonal() * residual;
    Insertion best;
    for (std::size_t j = 0; j < response_.grid().positions.size(); ++j) {
      const Vec3f p = response_.grid().positions[j];
      const Insertion i = insertion_at({p.x, p.y, p.z}, response_.grid_column(j), weighted);
      if (i.gain > best.gain) best = i;
    }
    LightEstimates chosen;
    const std::vector<std::size_t> darkest = darkest_receivers(residual);
    const float diagonal = response_.grid().region.diagonal();
    for (float t = kFarthestInFront; t > kNearestInFront; t /= 1.5F) {
      if (const auto place = best_place_in_front(darkest, t * diagonal, weighted)) chosen.push_back(*place);
    }
    chosen.push_back(best.light);
    return chosen;
  }

  void consider_insertions(const LightEstimates& lights) {
    for (const LightEstimate& inserted : insertions(lights)) {
      LightEstimates grown = lights;
      grown.push_back(inserted);
      consider(grown);
    }
  }

  std::vector<std::size_t> darkest_receivers(const Column& residual) const {
    std::vector<std::pair<double, std::size_t>> lack;
    for (Eigen::Index i = 0; i < residual.rows(); ++i) {
      const double painted = observations_.sqrt_weight[i] > 0 ? 1 : 0;
      lack.emplace_back(-painted * residual.row(i).sum(), std::size_t(i));
    }
    const std::size_t count = std::min(kDarkest, lack.size());
    std::partial_sort(lack.begin(), lack.begin() + std::ptrdiff_t(count), lack.end());
    std::vector<std::size_t> darkest;
    for (std::size_t k = 0; k < count; ++k) darkest.push_back(lack[k].second);
    return darkest;
  }

  // By direct light alone: the grid's indirect light says nothing about a place inside a fixture.
  std::optional<LightEstimate> best_place_in_front(const std::vector<std::size_t>& receivers, float distance,
                                                   const Column& weighted_residual) const {
    LightEstimates places;
    for (const std::size_t i : receivers) {
      const renderer::SurfaceSample& at = response_.receivers()[i];
      const renderer::Frame3f frame(at.normal);
      for (const Vec3f& direction : kDirectionsInFront) {
        const Vec3f p = at.position + distance * frame.world_from_local(direction);
        if (!response_.grid().region.contains(p)) continue;
        places.push_back({Eigen::Vector3d(p.x, p.y, p.z), Eigen::Array3d::Ones()});
        places.back().direct_only = true;
        places.back().correction = -response_.interpolated_indirect(places.back().position);
      }
    }
    const std::vector<Column> columns = evaluate_columns(response_, places, VisibilitySource::kTraced);
    std::optional<LightEstimate> best;
    double best_gain = 0;
    for (std::size_t j = 0; j < places.size(); ++j) {
      const Insertion i = insertion_at(places[j].position, columns[j], weighted_residual);
      if (i.gain <= best_gain) continue;
      best_gain = i.gain;
      best = places[j];
      best->intensity = i.light.intensity;
    }
    return best;
  }

  void insert_lights() {
    if (best_.size() < 2) consider_insertions({});
    int idle = 0;
    for (std::size_t size = knee(); idle < kIdleInsertions && int(size) < most_lights() && !out_of_time(); ++size) {
      if (size >= best_.size() || best_[size].lights.empty()) break;
      const double before = best_[knee()].error;
      if (before <= observations_.noise * kNoiseMargin && options_.exact_lights == 0) break;
      consider_insertions(LightEstimates(best_[size].lights));
      idle = best_.size() > size + 1 && best_[size + 1].error * kKnee < before ? 0 : idle + 1;
    }
  }

  // From the largest set down: without each light in turn, intensities refitted, the best of them refined.
  void eliminate_lights() {
    for (std::size_t size = best_.size() - 1; size > 1 && !out_of_time(); --size) {
      if (best_[size].lights.empty()) continue;
      const LightEstimates& all = best_[size].lights;
      const std::vector<Column> columns = evaluate_columns(response_, all, VisibilitySource::kTraced);
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
  const ExactIndirect& exact_;
  const Observations& observations_;
  const LightTree& tree_;
  LightCountOptions options_;
  Clock::time_point start_;
  std::vector<Candidate> best_{1};  // by number of lights
  int refinements_ = 0;
  bool out_of_time_ = false;
};

}  // namespace

LightCountResult choose_light_count(const LightResponse& response, const ExactIndirect& exact,
                                    const Observations& observations, const LightTree& tree,
                                    const LightCountOptions& options) {
  return Search(response, exact, observations, tree, options).run();
}

}  // namespace chiaro::inverse

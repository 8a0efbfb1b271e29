#include "inverse/solve/sets_without_one.h"

#include <utility>

namespace chiaro::inverse {
namespace {

struct RefittedSet {
  LightEstimates lights;
  double error = 0;
};

RefittedSet refitted_without(const Observations& observations, LightEstimates lights, std::vector<Column> columns,
                             std::size_t without) {
  lights.erase(lights.begin() + std::ptrdiff_t(without));
  columns.erase(columns.begin() + std::ptrdiff_t(without));
  const double error = refit_intensities(observations, columns, lights);
  return {std::move(lights), error};
}

}  // namespace

std::vector<LightEstimates> sets_without_one(const LightResponse& response, const Observations& observations,
                                             const LightEstimates& all, std::size_t most) {
  const std::vector<Column> columns = evaluate_columns(response, all, Evaluation::kTracedVisibility);
  std::vector<RefittedSet> sets;
  for (std::size_t without = 0; without < all.size(); ++without) {
    sets.push_back(refitted_without(observations, all, columns, without));
  }
  return best_sets(std::move(sets), most);
}

}  // namespace chiaro::inverse

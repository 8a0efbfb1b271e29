#include "inverse/solve/free_lights.h"

namespace chiaro::inverse {

void FreeLights::remove(std::size_t j) {
  const auto at = std::ptrdiff_t(j);
  number.erase(number.begin() + at);
  traced.erase(traced.begin() + at);
  now.erase(now.begin() + at);
  for (std::vector<Column>* columns : {&brought, &indirect_traced, &indirect, &carried}) {
    if (!columns->empty()) columns->erase(columns->begin() + at);
  }
}

FreeLights without(FreeLights free, const std::vector<std::size_t>& gone) {
  for (auto j = gone.rbegin(); j != gone.rend(); ++j) free.remove(*j);
  return free;
}

}  // namespace chiaro::inverse

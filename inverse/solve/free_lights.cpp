#include "inverse/solve/free_lights.h"

namespace chiaro::inverse {

FreeLights without(FreeLights free, const std::vector<std::size_t>& gone) {
  for (auto j = gone.rbegin(); j != gone.rend(); ++j) {
    const auto at = std::ptrdiff_t(*j);
    free.number.erase(free.number.begin() + at);
    free.traced.erase(free.traced.begin() + at);
    free.now.erase(free.now.begin() + at);
    for (std::vector<Column>* columns : {&free.brought, &free.indirect_traced, &free.indirect, &free.carried}) {
      if (!columns->empty()) columns->erase(columns->begin() + at);
    }
  }
  return free;
}

}  // namespace chiaro::inverse

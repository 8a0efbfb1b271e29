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

void let_the_dark_share(FreeLights& free) {
  for (std::size_t j = 0; j < free.now.size(); ++j) {
    if (!is_dark(free.now[j])) continue;
    const auto brightest = brightest_light(free.now);
    brightest->intensity /= 2;
    const auto shared = std::size_t(brightest - free.now.begin());
    free.traced[j] = free.traced[shared];
    free.now[j] = free.now[shared];
    free.brought[j] = free.brought[shared];
    free.indirect_traced[j] = free.indirect_traced[shared];
    free.indirect[j] = free.indirect[shared];
    if (!free.carried.empty()) free.carried[j] = free.carried[shared];
    free.number[j] = free.number[shared];
  }
}

}  // namespace chiaro::inverse

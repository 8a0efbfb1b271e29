#include "inverse/solve/not_told_apart.h"

#include <algorithm>
#include <set>

namespace chiaro::inverse {

std::vector<std::vector<int>> groups_not_told_apart(const SolveResult& result) {
  std::vector<std::set<int>> groups;
  for (const std::pair<int, int>& pair : result.not_told_apart) {
    std::set<int> linked{pair.first, pair.second};
    std::erase_if(groups, [&](std::set<int>& group) {
      const bool shared = group.contains(pair.first) || group.contains(pair.second);
      if (shared) linked.merge(group);
      return shared;
    });
    groups.push_back(std::move(linked));
  }
  std::vector<std::vector<int>> lists;
  for (const std::set<int>& group : groups) lists.emplace_back(group.begin(), group.end());
  std::sort(lists.begin(), lists.end());
  return lists;
}

}  // namespace chiaro::inverse

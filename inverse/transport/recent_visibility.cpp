#include "inverse/transport/recent_visibility.h"

#include <algorithm>

namespace chiaro::inverse {
namespace {

constexpr std::size_t kBytes = std::size_t(32) << 20;  // at most, but for a few places
constexpr std::size_t kLeast = 4, kMost = 512;         // places

}  // namespace

RecentVisibility::RecentVisibility(std::size_t receivers)
    : most_(std::clamp(kBytes / (sizeof(double) * std::max<std::size_t>(1, receivers)), kLeast, kMost)) {}

Visibility RecentVisibility::find(renderer::Vec3f place) {
  const std::lock_guard lock(mutex_);
  const auto known = std::find_if(known_.begin(), known_.end(), [&](const Known& k) { return k.place == place; });
  if (known == known_.end()) return nullptr;
  known->last_used = ++uses_;
  return known->visibility;
}

void RecentVisibility::add(renderer::Vec3f place, Visibility visibility) {
  const std::lock_guard lock(mutex_);
  Known known{place, ++uses_, std::move(visibility)};
  if (known_.size() < most_) {
    known_.push_back(std::move(known));
    return;
  }
  *std::min_element(known_.begin(), known_.end(),
                    [](const Known& a, const Known& b) { return a.last_used < b.last_used; }) = std::move(known);
}

}  // namespace chiaro::inverse

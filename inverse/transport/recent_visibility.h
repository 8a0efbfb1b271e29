#pragma once
// Which of some receivers see a light: searches come back to the same places over and over, and rays cost most.

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "renderer/core/vec.h"

namespace chiaro::inverse {

// By receiver, the part of the light that arrives.
using Visibility = std::shared_ptr<const std::vector<double>>;

// Of the places asked for last, as many as fit into some memory. Thread-safe.
class RecentVisibility {
 public:
  explicit RecentVisibility(std::size_t receivers);

  // Of this very place; null: it is not known, or no longer.
  Visibility find(renderer::Vec3f place);
  void add(renderer::Vec3f place, Visibility visibility);

 private:
  struct Known {
    renderer::Vec3f place;
    std::uint64_t last_used;
    Visibility visibility;
  };

  std::mutex mutex_;
  std::size_t most_;  // places
  std::uint64_t uses_ = 0;
  std::vector<Known> known_;
};

}  // namespace chiaro::inverse

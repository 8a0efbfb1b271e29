#pragma once

#include <deque>
#include <utility>

#include <Eigen/Core>

namespace chiaro::inverse {

// What was computed for some places, which serves others so near that it hardly is another there.
template <class Value>
class KnownPlaces {
 public:
  // near: metres.
  explicit KnownPlaces(double near) : near_(near) {}

  struct Known {
    Eigen::Vector3d position;
    Value value;
  };

  // Of the nearest place; null where none is near. Valid as long as these are.
  const Known* find(const Eigen::Vector3d& position) const {
    const Known* nearest = nullptr;
    double least = near_;
    for (const Known& known : known_) {
      const double distance = (known.position - position).norm();
      if (distance <= least) least = distance, nearest = &known;
    }
    return nearest;
  }

  void add(const Eigen::Vector3d& position, Value value) { known_.push_back({position, std::move(value)}); }

 private:
  double near_;
  std::deque<Known> known_;  // which does not move them
};

}  // namespace chiaro::inverse

#pragma once
// What shadow rays have learnt: how often a part of the scene sees each punctual light, so that lights behind walls are
// asked rarely. The parts are the cells of a regular grid, for each of the six ways that a surface may face.
//
// Counts are sums of whole numbers, taken up between passes: the same whatever the number of threads. Every light
// keeps a chance, so that what is learnt changes noise and nothing else.
// Source: after Vévoda, Kondapaneni, Křivánek, Bayesian Online Regression for Adaptive Direct Illumination Sampling,
// 2018 (here by counting).

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/core/vec.h"

namespace chiaro::renderer {

class LightVisibility {
 public:
  LightVisibility(const Box3f& bounds, std::size_t lights);

  // The part that a surface point belongs to. normal: as it faces; zero: all ways.
  std::size_t part_of(Vec3f point, Vec3f normal) const;
  // A shadow ray from there. Any thread may call it.
  void record(std::size_t part, std::size_t light, bool seen);
  // What was recorded counts from now on. Not while others record.
  void learn();
  // Per light, for its weight among all; padded to a multiple of kLanes.
  static constexpr std::size_t kLanes = 8;
  std::span<const float> factors(std::size_t part) const { return {&factors_[part * lights_], lights_}; }

 private:
  std::size_t lights_;  // padded
  Vec3f origin_, cells_per_metre_;
  int counts_[3];
  std::vector<std::atomic<std::uint64_t>> rays_;  // all in the low half, those that saw the light in the high one
  std::vector<float> factors_;
};

}  // namespace chiaro::renderer

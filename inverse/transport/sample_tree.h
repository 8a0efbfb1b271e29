#pragma once

#include <memory>
#include <span>
#include <vector>

#include "renderer/trace/trace_illumination.h"

namespace chiaro::inverse {

// Mean distance between neighbours, metres, if so many points lay evenly on the sides of a box.
float typical_spacing(const renderer::Box3f& box, std::size_t points);

// Surface samples, to find those nearest in position and orientation.
class SampleTree {
 public:
  // spacing: metres between neighbours, about: how far turning a normal counts as.
  SampleTree(std::vector<renderer::SurfaceSample> samples, float spacing);
  SampleTree(SampleTree&&) noexcept;
  ~SampleTree();

  const std::vector<renderer::SurfaceSample>& samples() const;
  // Fills `found` with the indices of the nearest, nearest first. Returns how many there are.
  std::size_t find_nearest(const renderer::SurfaceSample& at, std::span<std::uint32_t> found) const;
  // How far apart two samples count as, squared metres.
  float squared_distance(const renderer::SurfaceSample& a, const renderer::SurfaceSample& b) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace chiaro::inverse

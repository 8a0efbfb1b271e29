#include "inverse/transport/sample_tree.h"

#include <algorithm>
#include <cmath>

#include <nanoflann.hpp>

namespace chiaro::inverse {

using renderer::SurfaceSample;

namespace {

constexpr float kOrientationWeight = 3.0F;  // turning a normal by 1 counts as this many spacings

struct Cloud {
  std::vector<SurfaceSample> samples;
  float scale;
  std::size_t kdtree_get_point_count() const { return samples.size(); }
  float kdtree_get_pt(std::uint32_t i, std::size_t d) const {
    return d < 3 ? samples[i].position[int(d)] : scale * samples[i].normal[int(d) - 3];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 6, std::uint32_t>;

}  // namespace

float typical_spacing(const renderer::Box3f& box, std::size_t points) {
  const renderer::Vec3f e = box.extent();
  return std::sqrt(2 * (e.x * e.y + e.y * e.z + e.z * e.x) / float(std::max<std::size_t>(1, points)));
}

struct SampleTree::Tree {
  Cloud cloud;
  Index index{6, cloud, {8}};

  explicit Tree(Cloud of) : cloud(std::move(of)) { index.buildIndex(); }
};

SampleTree::SampleTree(std::vector<SurfaceSample> samples, float spacing)
    : tree_(std::make_unique<Tree>(Cloud{std::move(samples), kOrientationWeight * spacing})) {}

SampleTree::SampleTree(SampleTree&&) noexcept = default;

SampleTree::~SampleTree() = default;

const std::vector<SurfaceSample>& SampleTree::samples() const { return tree_->cloud.samples; }

std::size_t SampleTree::find_nearest(const SurfaceSample& at, std::span<std::uint32_t> found) const {
  const float scale = tree_->cloud.scale;
  const float query[6] = {at.position.x,       at.position.y,       at.position.z,
                          scale * at.normal.x, scale * at.normal.y, scale * at.normal.z};
  thread_local std::vector<float> squared_distance;
  squared_distance.resize(found.size());
  return tree_->index.knnSearch(query, found.size(), found.data(), squared_distance.data());
}

float SampleTree::squared_distance(const SurfaceSample& a, const SurfaceSample& b) const {
  const float scale = tree_->cloud.scale;
  return length_squared(a.position - b.position) + scale * scale * length_squared(a.normal - b.normal);
}

}  // namespace chiaro::inverse

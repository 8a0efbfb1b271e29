#include "inverse/transport/nearest_gather_point.h"

#include <array>

#include <nanoflann.hpp>

#include "inverse/transport/mutual_visibility.h"

namespace chiaro::inverse {

using renderer::SurfaceSample;
using renderer::Vec3f;

namespace {

constexpr float kOrientationWeight = 3.0F;  // turning a normal by 1 counts as this many spacings
constexpr std::size_t kCandidates = 4;

struct Cloud {
  std::vector<SurfaceSample> points;
  float scale;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::uint32_t i, std::size_t d) const {
    return d < 3 ? points[i].position[int(d)] : scale * points[i].normal[int(d) - 3];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 6, std::uint32_t>;

}  // namespace

struct NearestGatherPoint::Tree {
  Cloud cloud;
  Index index{6, cloud, {8}};

  explicit Tree(Cloud of) : cloud(std::move(of)) { index.buildIndex(); }
  std::size_t nearest(const SurfaceSample& at, std::size_t count, std::array<std::uint32_t, kCandidates>& found) const {
    const float query[6] = {at.position.x,
                            at.position.y,
                            at.position.z,
                            cloud.scale * at.normal.x,
                            cloud.scale * at.normal.y,
                            cloud.scale * at.normal.z};
    std::array<float, kCandidates> squared_distance{};
    return index.knnSearch(query, count, found.data(), squared_distance.data());
  }
};

NearestGatherPoint::NearestGatherPoint(const renderer::RayTracer& tracer, std::vector<SurfaceSample> points,
                                       float spacing)
    : tracer_(tracer), tree_(std::make_unique<Tree>(Cloud{std::move(points), kOrientationWeight * spacing})) {}

NearestGatherPoint::~NearestGatherPoint() = default;

std::optional<std::uint32_t> NearestGatherPoint::find_seen(const SurfaceSample& at) const {
  std::array<std::uint32_t, kCandidates> found{};
  const std::vector<SurfaceSample>& points = tree_->cloud.points;
  tree_->nearest(at, 1, found);
  if (see_each_other(tracer_, at, points[found[0]])) return found[0];
  const std::size_t count = tree_->nearest(at, kCandidates, found);
  for (std::size_t k = 1; k < count; ++k) {
    if (see_each_other(tracer_, at, points[found[k]])) return found[k];
  }
  return std::nullopt;
}

std::uint32_t NearestGatherPoint::find_nearest(const SurfaceSample& at) const {
  std::array<std::uint32_t, kCandidates> found{};
  tree_->nearest(at, 1, found);
  return found[0];
}

}  // namespace chiaro::inverse

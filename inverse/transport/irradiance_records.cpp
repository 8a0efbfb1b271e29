#include "inverse/transport/irradiance_records.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <nanoflann.hpp>

#include "inverse/transport/mutual_visibility.h"
#include "renderer/core/sampler.h"

namespace chiaro::inverse {
namespace {

using Share = IrradianceRecords::Share;
using renderer::RayTracer;
using renderer::Sampler;
using renderer::SurfaceSample;
using renderer::Vec3f;

constexpr int kProbeRays = 64;
constexpr float kReach = 0.08F;                // of the harmonic mean distance to the surfaces around
constexpr float kInterpolated = 1.8F;          // reaches, from within which records are taken
constexpr float kReachCosine = 0.99F;          // between normals, within reach of a record …
constexpr float kInterpolatedCosine = 0.967F;  // … and of records that are interpolated
constexpr float kMostRise = 0.25F;             // out of the tangent planes, of the distance
constexpr float kLeastPart = 0.2F;             // of the reach, at which records are dense enough
constexpr std::size_t kMostShares = 10;
constexpr double kMostNoise = 1.25;  // sum of the weights' magnitudes: more is extrapolation

class ReceiverTree {
 public:
  ReceiverTree(std::span<const SurfaceSample> receivers, std::vector<std::uint32_t> some)
      : cloud_{receivers, std::move(some)}, tree_(3, cloud_, {16}) {
    tree_.buildIndex();
  }

  struct Neighbour {
    std::uint32_t receiver;
    float distance;
  };
  void find(Vec3f at, float radius, std::vector<Neighbour>& found) const {
    std::vector<std::pair<std::uint32_t, float>> squared;
    tree_.radiusSearch(&at.x, radius * radius, squared, nanoflann::SearchParams(32, 0, false));
    found.clear();
    for (const auto& [i, d2] : squared) found.push_back({cloud_.some[i], std::sqrt(d2)});
  }

 private:
  struct Cloud {
    std::span<const SurfaceSample> receivers;
    std::vector<std::uint32_t> some;
    std::size_t kdtree_get_point_count() const { return some.size(); }
    float kdtree_get_pt(std::uint32_t i, std::size_t d) const { return receivers[some[i]].position[int(d)]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3, std::uint32_t>;
  Cloud cloud_;
  Tree tree_;
};

// Metres, for which a record stands at each receiver.
std::vector<float> reaches(const RayTracer& tracer, std::span<const SurfaceSample> receivers, std::uint64_t seed,
                           const renderer::Control& control) {
  std::vector<float> reach(receivers.size());
  const float farthest = tracer.bounds().diagonal();
  constexpr std::size_t kBlock = 64;
  renderer::parallel_for((receivers.size() + kBlock - 1) / kBlock, "records", control, [&](std::size_t block) {
    for (std::size_t i = block * kBlock; i < std::min(receivers.size(), (block + 1) * kBlock); ++i) {
      const renderer::Frame3f frame(receivers[i].normal);
      const Vec3f from = renderer::offset_point(receivers[i].position, receivers[i].normal);
      float inverse = 0;
      for (int k = 0; k < kProbeRays; ++k) {
        Sampler sampler(seed, std::uint32_t(i), std::uint32_t(k));
        const Vec3f direction =
            normalize(frame.world_from_local(renderer::sample_cosine_hemisphere(sampler.next_2d())));
        const auto hit = tracer.intersect({from, direction, 0, renderer::kInfinity, sampler.next_bits()});
        inverse += 1 / (hit ? std::max(hit->distance, 1e-6F * farthest) : farthest);
      }
      reach[i] = kReach * float(kProbeRays) / inverse;
    }
  });
  return reach;
}

bool alike(const SurfaceSample& a, const SurfaceSample& b, float distance, float least_cosine) {
  const Vec3f across = b.position - a.position;
  const float most = kMostRise * distance;
  return dot(a.normal, b.normal) >= least_cosine && std::abs(dot(across, a.normal)) <= most &&
         std::abs(dot(across, b.normal)) <= most;
}

std::vector<std::uint32_t> in_no_order(std::vector<std::uint32_t> receivers, std::uint64_t seed) {
  const auto key = [&](std::uint32_t i) { return renderer::hash_combine(i, std::uint32_t(seed)); };
  std::sort(receivers.begin(), receivers.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  return receivers;
}

// Each of the candidates in turn that none chosen before reaches, with so much of its reach.
std::vector<std::uint32_t> choose(std::span<const SurfaceSample> receivers, const std::vector<float>& reach,
                                  const std::vector<std::uint32_t>& candidates, float part) {
  const ReceiverTree tree(receivers, candidates);
  std::vector<char> reached(receivers.size(), 0);
  std::vector<ReceiverTree::Neighbour> near;
  std::vector<std::uint32_t> records;
  for (const std::uint32_t i : candidates) {
    if (reached[i] != 0) continue;
    records.push_back(i);
    tree.find(receivers[i].position, part * reach[i], near);
    for (const auto& [other, distance] : near) {
      if (distance <= part * reach[other] && alike(receivers[i], receivers[other], distance, kReachCosine)) {
        reached[other] = 1;
      }
    }
  }
  return records;
}

// Weights that give any function exactly that is linear along the tangent plane; empty where records are too few or
// stand to one side.
std::vector<Share> interpolate(const RayTracer& tracer, std::span<const SurfaceSample> receivers,
                               std::uint32_t receiver, float radius, std::vector<ReceiverTree::Neighbour> near) {
  const SurfaceSample& at = receivers[receiver];
  const renderer::Frame3f frame(at.normal);
  std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) {
    return std::tie(a.distance, a.receiver) < std::tie(b.distance, b.receiver);
  });
  std::vector<Share> shares;
  std::vector<Eigen::Vector3d> basis;
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  for (const auto& [record, distance] : near) {
    const SurfaceSample& other = receivers[record];
    if (!alike(at, other, distance, kInterpolatedCosine) || !see_each_other(tracer, at, other)) continue;
    const Vec3f local = frame.local_from_world(other.position - at.position) / radius;
    basis.emplace_back(1, double(local.x), double(local.y));
    const double kernel = std::pow(1 - double(distance / radius), 2) + 1e-4;
    shares.push_back({record, float(kernel)});
    normal_matrix += kernel * basis.back() * basis.back().transpose();
    if (shares.size() == kMostShares) break;
  }
  if (shares.size() < 3) return {};
  const Eigen::LDLT<Eigen::Matrix3d> solver(normal_matrix);
  if (solver.vectorD().minCoeff() < 1e-3 * solver.vectorD().maxCoeff()) return {};
  const Eigen::Vector3d first = solver.solve(Eigen::Vector3d::UnitX());
  double magnitudes = 0, sum = 0;
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const double weight = double(shares[k].weight) * basis[k].dot(first);
    shares[k].weight = float(weight);
    magnitudes += std::abs(weight), sum += weight;
  }
  if (!(magnitudes <= kMostNoise) || !(std::abs(sum - 1) < 1e-3)) return {};
  return shares;
}

// Shares by receiver become shares by record.
IrradianceRecords numbered(const std::vector<std::vector<Share>>& shares) {
  IrradianceRecords records;
  std::vector<std::uint32_t> place(shares.size());
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (shares[i].size() > 1) continue;
    place[i] = std::uint32_t(records.receivers.size());
    records.receivers.push_back(i);
  }
  records.share_start.push_back(0);
  for (const std::vector<Share>& of_receiver : shares) {
    for (const auto& [receiver, weight] : of_receiver) records.shares.push_back({place[receiver], weight});
    records.share_start.push_back(records.shares.size());
  }
  return records;
}

}  // namespace

IrradianceRecords choose_irradiance_records(const RayTracer& tracer, std::span<const SurfaceSample> receivers,
                                            std::uint64_t seed, const renderer::Control& control) {
  const std::vector<float> reach = reaches(tracer, receivers, seed, control);
  std::vector<std::uint32_t> left(receivers.size()), records;
  std::iota(left.begin(), left.end(), 0U);
  left = in_no_order(std::move(left), seed);
  std::vector<std::vector<Share>> shares(receivers.size());
  // Where records do not surround a receiver, some more are chosen.
  for (float part = 1; !left.empty(); part /= 2) {
    for (const std::uint32_t i : part < kLeastPart ? left : choose(receivers, reach, left, part)) {
      shares[i] = {{i, 1}};
      records.push_back(i);
    }
    const ReceiverTree tree(receivers, records);
    renderer::parallel_for(left.size(), "", control, [&](std::size_t k) {
      const std::uint32_t i = left[k];
      if (!shares[i].empty()) return;
      std::vector<ReceiverTree::Neighbour> near;
      const float radius = kInterpolated * reach[i];
      tree.find(receivers[i].position, radius, near);
      shares[i] = interpolate(tracer, receivers, i, radius, std::move(near));
    });
    std::erase_if(left, [&](std::uint32_t i) { return !shares[i].empty(); });
  }
  return numbered(shares);
}

IrradianceRecords records_of(const IrradianceRecords& all, std::span<const std::size_t> chosen) {
  constexpr std::uint32_t kNotWanted = ~0U;
  std::vector<std::uint32_t> place(all.receivers.size(), kNotWanted);
  for (const std::size_t receiver : chosen) {
    for (const auto& share : all.of(receiver)) place[share.record] = 0;
  }
  IrradianceRecords some;
  for (std::size_t k = 0; k < place.size(); ++k) {
    if (place[k] == kNotWanted) continue;
    place[k] = std::uint32_t(some.receivers.size());
    some.receivers.push_back(all.receivers[k]);
  }
  some.share_start.push_back(0);
  for (const std::size_t receiver : chosen) {
    for (const auto& share : all.of(receiver)) some.shares.push_back({place[share.record], share.weight});
    some.share_start.push_back(some.shares.size());
  }
  return some;
}

LightBlock interpolate(const IrradianceRecords& records, std::size_t receiver, std::span<const LightBlock> of_records) {
  LightBlock sum;
  for (const auto& [record, weight] : records.of(receiver)) {
    for (int c = 0; c < 3; ++c) {
      for (int l = 0; l < kLightBlock; ++l) sum.channel[c][l] += weight * of_records[record].channel[c][l];
    }
  }
  for (auto& channel : sum.channel) {
    for (float& value : channel) value = std::max(0.0F, value);
  }
  return sum;
}

}  // namespace chiaro::inverse

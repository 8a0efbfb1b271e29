#include "inverse/transport/light_response.h"

#include "inverse/transport/eigen_vectors.h"
#include "inverse/transport/gather_operator.h"
#include "renderer/core/control.h"
#include "renderer/core/error.h"

namespace chiaro::inverse {
namespace {

using Eigen::Vector3d;
using renderer::SurfaceSample;

struct DirectTerm {
  double value;
  Vector3d gradient;
};

// cosθ / (π d²) and its gradient in the light's position: with r = x − p, n·r / (π |r|³).
DirectTerm direct_term(const SurfaceSample& at, const Vector3d& light) {
  const Vector3d r = light - to_eigen(at.position), n = to_eigen(at.normal);
  const double projected = n.dot(r);
  if (projected <= 0) return {0, Vector3d::Zero()};
  const double d2 = r.squaredNorm(), scale = 1 / (EIGEN_PI * d2 * std::sqrt(d2));
  return {projected * scale, scale * (n - (3 * projected / d2) * r)};
}

}  // namespace

LightResponse::LightResponse(const renderer::RayTracer& tracer, std::vector<SurfaceSample> receivers,
                             const TransportCache& cache)
    : tracer_(tracer), receivers_(std::move(receivers)), cache_(cache) {
  CHIARO_CHECK(cache.receiver_count == receivers_.size());
}

// Trilinear; nodes left out of the grid lose their share to the others.
std::vector<LightResponse::Weight> LightResponse::interpolation_weights(const Vector3d& position) const {
  const LightGrid& grid = cache_.grid;
  int low[3];
  double t[3], slope[3];
  for (int a = 0; a < 3; ++a) {
    const int last = grid.counts[a] - 1;
    const double at = last > 0 ? (position[a] - double(grid.origin[a])) / double(grid.spacing[a]) : 0;
    const double inside = std::clamp(at, 0.0, double(last));
    low[a] = std::min(int(inside), std::max(0, last - 1));
    t[a] = last > 0 ? inside - low[a] : 0;
    slope[a] = last > 0 && at == inside ? 1 / double(grid.spacing[a]) : 0;
  }
  std::vector<Weight> weights;
  double total = 0;
  Vector3d total_gradient = Vector3d::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    double w[3], dw[3];
    std::size_t node = 0, stride = 1;
    bool exists = true;
    for (int a = 0; a < 3; ++a) {
      const bool high = (corner >> a & 1) != 0;
      exists = exists && (!high || grid.counts[a] > 1);
      w[a] = high ? t[a] : 1 - t[a];
      dw[a] = high ? slope[a] : -slope[a];
      node += stride * std::size_t(low[a] + (high ? 1 : 0));
      stride *= std::size_t(grid.counts[a]);
    }
    if (!exists || grid.light_of_node[node] < 0) continue;
    const Vector3d gradient{dw[0] * w[1] * w[2], w[0] * dw[1] * w[2], w[0] * w[1] * dw[2]};
    weights.push_back({std::size_t(grid.light_of_node[node]), w[0] * w[1] * w[2], gradient});
    total += weights.back().value;
    total_gradient += gradient;
  }
  if (total < 1e-6) {  // amid nodes that were all left out: the nearest light stands for them
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < grid.positions.size(); ++j) {
      const double d = (to_eigen(grid.positions[j]) - position).squaredNorm();
      if (d < least) least = d, nearest = j;
    }
    return {{nearest, 1, Vector3d::Zero()}};
  }
  for (Weight& w : weights) {
    w.gradient = (w.gradient - (w.value / total) * total_gradient) / total;
    w.value /= total;
  }
  return weights;
}

std::vector<double> LightResponse::visibility(const Vector3d& position, VisibilitySource source,
                                              const std::vector<Weight>& weights) const {
  std::vector<double> visible(receivers_.size(), 0);
  const Vec3f light = to_vec3f(position);
  if (source == VisibilitySource::kTraced) {
    constexpr std::size_t kBlock = 1024;
    renderer::parallel_for((receivers_.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
      for (std::size_t i = block * kBlock; i < std::min(receivers_.size(), (block + 1) * kBlock); ++i) {
        visible[i] = sees(tracer_, receivers_[i], light, std::uint32_t(i)) ? 1 : 0;
      }
    });
    return visible;
  }
  for (std::size_t i = 0; i < receivers_.size(); ++i) {
    const SurfaceSample& at = receivers_[i];
    if (dot(light - at.position, at.normal) <= 0) continue;
    // Nodes behind the receiver know nothing of what stands in front of it.
    double total = 0;
    for (const Weight& w : weights) {
      if (dot(cache_.grid.positions[w.light] - at.position, at.normal) <= 0) continue;
      total += w.value;
      visible[i] += w.value * cache_.visibility[w.light * cache_.receiver_count + i];
    }
    visible[i] = total > 0 ? visible[i] / total : 1;
  }
  return visible;
}

ColumnWithGradient LightResponse::evaluate_with_gradient(const Vector3d& position, VisibilitySource source) const {
  const std::vector<Weight> weights = interpolation_weights(position);
  const std::vector<double> visible = visibility(position, source, weights);
  ColumnWithGradient column;
  column.value.resize(Eigen::Index(receivers_.size()), 3);
  for (Column& g : column.gradient) g.resize(Eigen::Index(receivers_.size()), 3);
  for (std::size_t i = 0; i < receivers_.size(); ++i) {
    const auto row = Eigen::Index(i);
    const DirectTerm direct = visible[i] > 0 ? direct_term(receivers_[i], position) : DirectTerm{0, Vector3d::Zero()};
    column.value.row(row).setConstant(visible[i] * direct.value);
    for (int a = 0; a < 3; ++a) column.gradient[a].row(row).setConstant(visible[i] * direct.gradient[a]);
    for (const Weight& w : weights) {
      const Vector3d indirect = to_eigen(cache_.indirect[w.light * cache_.receiver_count + i]);
      column.value.row(row) += w.value * indirect.transpose();
      for (int a = 0; a < 3; ++a) column.gradient[a].row(row) += w.gradient[a] * indirect.transpose();
    }
  }
  return column;
}

Column LightResponse::indirect(const std::vector<Weight>& weights) const {
  Column column = Column::Zero(Eigen::Index(receivers_.size()), 3);
  for (const Weight& w : weights) {
    const Vec3f* indirect = &cache_.indirect[w.light * cache_.receiver_count];
    for (std::size_t i = 0; i < receivers_.size(); ++i) {
      column.row(Eigen::Index(i)) += w.value * to_eigen(indirect[i]).transpose();
    }
  }
  return column;
}

Column LightResponse::interpolated_indirect(const Vector3d& position) const {
  return indirect(interpolation_weights(position));
}

void LightResponse::add_direct(const Vector3d& position, const std::vector<double>& visible, Column& column) const {
  for (std::size_t i = 0; i < receivers_.size(); ++i) {
    if (visible[i] <= 0) continue;
    const double direct = visible[i] * double(unoccluded_illumination(receivers_[i], to_vec3f(position)));
    column.row(Eigen::Index(i)).array() += direct;
  }
}

Column LightResponse::direct(const Vector3d& position) const {
  Column column = Column::Zero(Eigen::Index(receivers_.size()), 3);
  add_direct(position, visibility(position, VisibilitySource::kTraced, {}), column);
  return column;
}

Column LightResponse::evaluate(const Vector3d& position, VisibilitySource source) const {
  const std::vector<Weight> weights = interpolation_weights(position);
  Column column = indirect(weights);
  add_direct(position, visibility(position, source, weights), column);
  return column;
}

Column LightResponse::interpolated_columns(const Vector3d& position) const {
  Column column = Column::Zero(Eigen::Index(receivers_.size()), 3);
  for (const Weight& w : interpolation_weights(position)) column += w.value * grid_column(w.light);
  return column;
}

Column LightResponse::grid_column(std::size_t light) const {
  Column column(Eigen::Index(receivers_.size()), 3);
  for (std::size_t i = 0; i < receivers_.size(); ++i) {
    const std::size_t entry = light * cache_.receiver_count + i;
    const double direct = cache_.visibility[entry] != 0
                              ? double(unoccluded_illumination(receivers_[i], cache_.grid.positions[light]))
                              : 0;
    column.row(Eigen::Index(i)) = (Vector3d::Constant(direct) + to_eigen(cache_.indirect[entry])).transpose();
  }
  return column;
}

}  // namespace chiaro::inverse

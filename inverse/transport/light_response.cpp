#include "inverse/transport/light_response.h"

#include <algorithm>
#include <limits>

#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/control.h"
#include "renderer/core/error.h"

namespace chiaro::inverse {
namespace {

using Eigen::Vector3d;
using renderer::SurfaceSample;

// Where nothing is left to interpolate, a light may be of any shape.
void check_kind(const UnityLight& light, Evaluation evaluation, const GatherOperator* gather) {
  CHIARO_CHECK(!light.cone || evaluation == Evaluation::kExact);
  CHIARO_CHECK(gather != nullptr || evaluation != Evaluation::kExact);
}

template <class Lanes>
Column column_of(const std::vector<Lanes>& illumination, int lane) {
  Column column(Eigen::Index(illumination.size()), 3);
  for (std::size_t i = 0; i < illumination.size(); ++i) {
    for (int c = 0; c < 3; ++c) column(Eigen::Index(i), c) = double(illumination[i].channel[c][lane]);
  }
  return column;
}

std::vector<std::size_t> lights_near(const LightGrid& grid, const AllowedPlaces& places) {
  constexpr double kNowhere = std::numeric_limits<double>::infinity();
  std::vector<double> distance(grid.positions.size());
  renderer::parallel_for(distance.size(), [&](std::size_t j) {
    const Vector3d position = to_eigen(grid.positions[j]);
    const auto place = places.nearest(position);
    distance[j] = place ? (*place - position).norm() : kNowhere;
  });
  double reach = double(length(grid.spacing));
  if (!distance.empty()) reach = std::max(reach, *std::min_element(distance.begin(), distance.end()));
  std::vector<std::size_t> lights;
  for (std::size_t j = 0; j < distance.size(); ++j) {
    if (distance[j] <= reach && distance[j] < kNowhere) lights.push_back(j);
  }
  return lights;
}

}  // namespace

LightResponse::LightResponse(const renderer::RayTracer& tracer, std::vector<SurfaceSample> receivers,
                             const TransportCache& cache, const GatherOperator* gather)
    : LightResponse(tracer, std::move(receivers), cache, AllowedPlaces(cache.grid.region)) {
  gather_ = gather;
}

LightResponse::LightResponse(const renderer::RayTracer& tracer, std::vector<SurfaceSample> receivers,
                             const TransportCache& cache, AllowedPlaces places)
    : tracer_(tracer),
      receivers_(std::move(receivers)),
      cache_(cache),
      interpolation_(tracer, cache.grid),
      places_(std::move(places)),
      near_places_(lights_near(cache.grid, places_)),
      recent_visibility_(std::make_shared<RecentVisibility>(receivers_.size())) {
  CHIARO_CHECK(cache.receiver_count == receivers_.size());
}

std::vector<Vector3d> LightResponse::places_near_grid_lights() const {
  std::vector<Vector3d> places;
  for (const std::size_t j : near_places_) {
    if (const auto place = places_.nearest(to_eigen(cache_.grid.positions[j]))) places.push_back(*place);
  }
  return places;
}

Visibility LightResponse::visibility(const Vector3d& position, Evaluation evaluation,
                                     const std::vector<GridWeight>& weights) const {
  const Vec3f light = to_vec3f(position);
  if (evaluation != Evaluation::kInterpolated) return traced_visibility(light);
  return std::make_shared<const std::vector<double>>(interpolated_visibility(light, weights));
}

Visibility LightResponse::traced_visibility(Vec3f light) const {
  if (Visibility known = recent_visibility_->find(light)) return known;
  auto visible = std::make_shared<std::vector<double>>(receivers_.size());
  constexpr std::size_t kBlock = 1024;
  renderer::parallel_for((receivers_.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
    for (std::size_t i = block * kBlock; i < std::min(receivers_.size(), (block + 1) * kBlock); ++i) {
      (*visible)[i] = double(visible_part(tracer_, receivers_[i], light));
    }
  });
  recent_visibility_->add(light, visible);
  return visible;
}

std::vector<double> LightResponse::interpolated_visibility(Vec3f light, const std::vector<GridWeight>& weights) const {
  std::vector<double> visible(receivers_.size(), 0);
  for (std::size_t i = 0; i < receivers_.size(); ++i) {
    const SurfaceSample& at = receivers_[i];
    if (dot(light - at.position, at.normal) <= 0) continue;
    // Nodes behind the receiver know nothing of what stands in front of it.
    double total = 0;
    for (const GridWeight& w : weights) {
      if (dot(cache_.grid.positions[w.light] - at.position, at.normal) <= 0) continue;
      total += w.value;
      visible[i] += w.value * cache_.visibility[w.light * cache_.receiver_count + i];
    }
    visible[i] = total > 0 ? visible[i] / total : 1;
  }
  return visible;
}

// Lane 0 of each block is the value, the others the derivatives.
ColumnWithGradient LightResponse::gathered_with_gradient(const UnityLight& light) const {
  const std::vector<LightQuad> indirect = indirect_illumination_with_gradient(tracer_, *gather_, light);
  return {column_of(indirect, 0), {column_of(indirect, 1), column_of(indirect, 2), column_of(indirect, 3)}};
}

Column LightResponse::exact(const UnityLight& light) const {
  Column column = column_of(indirect_illumination(tracer_, *gather_, light), 0);
  const Visibility seen = visibility(light.position, Evaluation::kExact, {});
  const std::vector<double>& visible = *seen;
  for (std::size_t i = 0; i < receivers_.size(); ++i) {
    if (visible[i] > 0) column.row(Eigen::Index(i)).array() += unoccluded_term(receivers_[i], light).value;
  }
  return column;
}

// Σ w N over grid lights, w their value and its three derivatives, or the value alone.
template <int Lanes>
std::array<Column, Lanes> LightResponse::sums_of_indirect(const std::vector<GridWeight>& weights) const {
  constexpr Eigen::Index kReceivers = 128;                                 // so that sums stay in the first cache
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;  // RGB by RGB, as cached
  std::array<Column, Lanes> sums;
  for (Column& sum : sums) sum.resize(Eigen::Index(receivers_.size()), 3);
  Eigen::Matrix<double, Eigen::Dynamic, Lanes> some(3 * kReceivers, Lanes);
  Eigen::VectorXd indirect;
  for (Eigen::Index first = 0; first < sums[0].rows(); first += kReceivers) {
    const Eigen::Index count = std::min(kReceivers, sums[0].rows() - first);
    some.setZero();
    for (const GridWeight& w : weights) {
      const float* cached = &cache_.indirect[w.light * cache_.receiver_count + std::size_t(first)].x;
      indirect = Eigen::Map<const Eigen::VectorXf>(cached, 3 * count).cast<double>();
      some.col(0).head(3 * count) += w.value * indirect;
      for (int l = 1; l < Lanes; ++l) some.col(l).head(3 * count) += w.gradient[l - 1] * indirect;
    }
    for (int l = 0; l < Lanes; ++l) {
      sums[std::size_t(l)].middleRows(first, count) = Eigen::Map<const Rows>(some.col(l).data(), count, 3);
    }
  }
  return sums;
}

Column LightResponse::indirect(const std::vector<GridWeight>& weights) const { return sums_of_indirect<1>(weights)[0]; }

ColumnWithGradient LightResponse::indirect_with_gradient(const std::vector<GridWeight>& weights) const {
  std::array<Column, 4> sums = sums_of_indirect<4>(weights);
  return {std::move(sums[0]), {std::move(sums[1]), std::move(sums[2]), std::move(sums[3])}};
}

ColumnWithGradient LightResponse::evaluate_with_gradient(const UnityLight& light, Evaluation evaluation) const {
  check_kind(light, evaluation, gather_);
  const bool exact = evaluation == Evaluation::kExact;
  const std::vector<GridWeight> weights = exact ? std::vector<GridWeight>() : interpolation_.weights(light.position);
  const Visibility seen = visibility(light.position, evaluation, weights);
  const std::vector<double>& visible = *seen;
  ColumnWithGradient column = exact ? gathered_with_gradient(light) : indirect_with_gradient(weights);
  Eigen::ArrayX4d direct = Eigen::ArrayX4d::Zero(Eigen::Index(receivers_.size()), 4);  // value, derivatives
  for (std::size_t i = 0; i < receivers_.size(); ++i) {
    if (!(visible[i] > 0)) continue;
    const DirectTerm term = unoccluded_term(receivers_[i], light);
    direct.row(Eigen::Index(i)) << term.value, term.gradient.transpose().array();
    direct.row(Eigen::Index(i)) *= visible[i];
  }
  column.value.colwise() += direct.col(0).matrix();
  for (int a = 0; a < 3; ++a) column.gradient[a].colwise() += direct.col(1 + a).matrix();
  return column;
}

Column LightResponse::interpolated_indirect(const Vector3d& position) const {
  return indirect(interpolation_.weights(position));
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
  add_direct(position, *visibility(position, Evaluation::kTracedVisibility, {}), column);
  return column;
}

Eigen::VectorXd LightResponse::unoccluded(const Vector3d& position) const {
  Eigen::VectorXd grey(Eigen::Index(receivers_.size()));
  for (std::size_t i = 0; i < receivers_.size(); ++i) {
    grey[Eigen::Index(i)] = double(unoccluded_illumination(receivers_[i], to_vec3f(position)));
  }
  return grey;
}

Column LightResponse::evaluate(const UnityLight& light, Evaluation evaluation) const {
  check_kind(light, evaluation, gather_);
  if (evaluation == Evaluation::kExact) return exact(light);
  const std::vector<GridWeight> weights = interpolation_.weights(light.position);
  Column column = indirect(weights);
  add_direct(light.position, *visibility(light.position, evaluation, weights), column);
  return column;
}

Column LightResponse::interpolated_columns(const Vector3d& position) const {
  Column column = Column::Zero(Eigen::Index(receivers_.size()), 3);
  for (const GridWeight& w : interpolation_.weights(position)) column += w.value * grid_column(w.light);
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

#pragma once
// The illumination of chosen receivers under a unity light at any position.
//
//   φ(x) = V cosθ / (π d²) + N(x)
//
// The direct term is taken at x exactly, its visibility V traced or interpolated between grid lights; the indirect term
// N is gathered for x itself or interpolated between grid lights. Gradients hold V fixed.

#include <Eigen/Core>

#include "inverse/transport/allowed_places.h"
#include "inverse/transport/gather_operator.h"
#include "inverse/transport/grid_interpolation.h"
#include "inverse/transport/recent_visibility.h"
#include "inverse/transport/transport_cache.h"

namespace chiaro::inverse {

using Column = Eigen::Matrix<double, Eigen::Dynamic, 3>;  // receivers × RGB, cd/m² per candela

struct ColumnWithGradient {
  Column value;
  std::array<Column, 3> gradient;  // by x, y, z; per metre
};

enum class Evaluation : std::uint8_t {
  kInterpolated,      // V and N between grid lights
  kTracedVisibility,  // V traced, N between grid lights
  kExact,             // V traced, N gathered; the only one for spots
};

class LightResponse {
 public:
  // `cache` holds the columns of `receivers` only, in their order. `gather`, for exact evaluations, has their rows.
  // Keeps references to tracer, cache and gather.
  LightResponse(const renderer::RayTracer& tracer, std::vector<renderer::SurfaceSample> receivers,
                const TransportCache& cache, const GatherOperator* gather = nullptr);

  // The same for lights that may stand in some places of the grid's region, or near it.
  LightResponse(const renderer::RayTracer& tracer, std::vector<renderer::SurfaceSample> receivers,
                const TransportCache& cache, AllowedPlaces places);

  std::size_t receiver_count() const { return receivers_.size(); }
  const std::vector<renderer::SurfaceSample>& receivers() const { return receivers_; }
  const LightGrid& grid() const { return cache_.grid; }
  const AllowedPlaces& places() const { return places_; }
  // Those of the grid's lights that have an allowed place no farther than a cell's diagonal; where none has, the
  // nearest.
  const std::vector<std::size_t>& grid_lights_near_places() const { return near_places_; }
  // The allowed places nearest to them, of as many as one is found for.
  std::vector<Eigen::Vector3d> places_near_grid_lights() const;

  // Positions outside the grid's region take the indirect part of the nearest point of its border.
  Column evaluate(const UnityLight& light, Evaluation evaluation) const;
  ColumnWithGradient evaluate_with_gradient(const UnityLight& light, Evaluation evaluation) const;
  // The direct part alone, visibility traced; as if nothing were in the way, of any channel; the indirect part alone.
  Column direct(const Eigen::Vector3d& position) const;
  Eigen::VectorXd unoccluded(const Eigen::Vector3d& position) const;
  Column interpolated_indirect(const Eigen::Vector3d& position) const;
  // Whole columns interpolated, direct light and all, as published.
  Column interpolated_columns(const Eigen::Vector3d& position) const;
  // The column of a grid light, as baked.
  Column grid_column(std::size_t light) const;

 private:
  template <int Lanes>
  std::array<Column, Lanes> sums_of_indirect(const std::vector<GridWeight>& weights) const;
  Column indirect(const std::vector<GridWeight>& weights) const;
  ColumnWithGradient indirect_with_gradient(const std::vector<GridWeight>& weights) const;
  ColumnWithGradient gathered_with_gradient(const UnityLight& light) const;
  Column exact(const UnityLight& light) const;
  void add_direct(const Eigen::Vector3d& position, const std::vector<double>& visible, Column& column) const;
  Visibility visibility(const Eigen::Vector3d& position, Evaluation evaluation,
                        const std::vector<GridWeight>& weights) const;
  Visibility traced_visibility(Vec3f light) const;
  std::vector<double> interpolated_visibility(Vec3f light, const std::vector<GridWeight>& weights) const;

  const renderer::RayTracer& tracer_;
  std::vector<renderer::SurfaceSample> receivers_;
  const TransportCache& cache_;
  GridInterpolation interpolation_;
  const GatherOperator* gather_ = nullptr;
  AllowedPlaces places_;
  std::vector<std::size_t> near_places_;
  std::shared_ptr<RecentVisibility> recent_visibility_;  // of the receivers
};

}  // namespace chiaro::inverse

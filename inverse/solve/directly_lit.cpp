#include "inverse/solve/directly_lit.h"

namespace chiaro::inverse {
namespace {

TransportCache direct_transport(const LightGrid& grid, std::size_t receivers) {
  TransportCache direct;
  direct.grid.region = grid.region;
  direct.grid.counts = {1, 1, 1};
  direct.grid.light_of_node = {0};
  direct.grid.positions = {(grid.region.min + grid.region.max) / 2};
  direct.receiver_count = receivers;
  direct.visibility.resize(receivers);
  direct.indirect.resize(receivers);
  return direct;
}

}  // namespace

DirectlyLit::DirectlyLit(const renderer::RayTracer& tracer, const LightResponse& search,
                         const std::vector<renderer::SurfaceSample>& receivers)
    : transport_(direct_transport(search.grid(), receivers.size())),
      response_(tracer, receivers, transport_, search.places()) {}

}  // namespace chiaro::inverse

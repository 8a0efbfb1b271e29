#pragma once

#include <functional>

#include "inverse/transport/gather_operator.h"
#include "inverse/transport/receivers.h"
#include "inverse/transport/transport_cache.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {

struct BakeSummary {
  double direct_seconds = 0, indirect_seconds = 0, check_seconds = 0, write_seconds = 0;
  std::size_t shadow_rays = 0, gather_rays = 0, gather_points = 0;
};

// Transport from every light of the grid to every receiver: direct visibility, and indirect light through shared gather
// points (gather_operator.h). Entries do not depend on the parts that they are computed in, nor on what was before.
class Baker {
 public:
  // Traces the gather points. Keeps references to tracer and receivers, which must outlive it. `memory`: bytes that it
  // may work with beyond them; Error where they are too few.
  Baker(const renderer::RayTracer& tracer, const Receivers& receivers, const LightGrid& grid,
        const BakeSettings& settings, double memory, const renderer::Control& control = {});

  // What a cache has but for its entries.
  const TransportCache& header() const { return header_; }
  const BakeSummary& summary() const { return summary_; }

  // From where a bake begins or goes on, in the order of TransportCacheWriter.
  struct Place {
    std::size_t light = 0, receiver = 0;
  };
  // Receivers [first, last), in blocks, from `start` on. Progress is that of the whole.
  void bake(std::size_t first, std::size_t last, Place start, const std::function<void(const TransportBlock&)>& visit,
            const renderer::Control& control);

 private:
  void choose_lights(std::size_t first, std::size_t count, const renderer::Control& control);
  const SparseTransport& rows_of(std::size_t first_receiver, std::size_t count, const renderer::Control& control);
  void fill_direct(TransportBlock& block, const renderer::Control& control);
  void fill_indirect(TransportBlock& block, const renderer::Control& control);
  double measure_indirect_error(const renderer::Control& control);

  const renderer::RayTracer& tracer_;
  const Receivers& receivers_;
  TransportCache header_;
  BakeSummary summary_;
  GatherOptions options_;
  GatherOperator gather_;
  std::size_t receivers_at_once_;
  // Of the lights chosen last: illumination of the gather points, block by block of them.
  std::size_t first_chosen_ = 0, chosen_ = 0;
  std::vector<std::vector<LightBlock>> illumination_;
  // Rows of K_rg by their first receiver; all of them where memory allows, or else the last.
  bool keeps_rows_;
  struct Rows {
    std::size_t first_receiver = 0;
    SparseTransport rows;
  };
  std::vector<Rows> rows_;
};

struct BakeResult {
  TransportCache cache;
  BakeSummary summary;
};

// All of it in memory.
BakeResult bake(const renderer::RayTracer& tracer, const Receivers& receivers, const LightGrid& grid,
                const BakeSettings& settings, const renderer::Control& control = {});

}  // namespace chiaro::inverse

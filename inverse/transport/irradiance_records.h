#pragma once
// At which receivers indirect light is gathered, the records, and how that of the others follows from it: linearly
// along the surface, as it varies slowly there. Close to other surfaces records are dense.
// Source: Ward, Rubinstein, Clear, A Ray Tracing Solution for Diffuse Interreflection, 1988 (how far a record reaches);
// interpolated by moving least squares (Levin, The Approximation Power of Moving Least-Squares, 1998).

#include <span>
#include <vector>

#include "inverse/transport/sparse_transport.h"
#include "renderer/core/control.h"
#include "renderer/trace/trace_illumination.h"

namespace chiaro::inverse {

struct IrradianceRecords {
  struct Share {
    std::uint32_t record;  // index into `receivers`
    float weight;
  };
  std::vector<std::size_t> receivers;    // that are records, in their order
  std::vector<std::size_t> share_start;  // receiver i has the shares share_start[i] … share_start[i + 1] − 1
  std::vector<Share> shares;             // weights of one receiver add up to 1; a record has itself alone

  std::span<const Share> of(std::size_t receiver) const {
    return {shares.data() + share_start[receiver], shares.data() + share_start[receiver + 1]};
  }
};

// Does not depend on the number of threads.
IrradianceRecords choose_irradiance_records(const renderer::RayTracer& tracer,
                                            std::span<const renderer::SurfaceSample> receivers, std::uint64_t seed,
                                            const renderer::Control& control = {});

// Those of some receivers, which are numbered by their place in `chosen`, and no further records.
IrradianceRecords records_of(const IrradianceRecords& all, std::span<const std::size_t> chosen);

// Illumination of a receiver from that of the records. Never below zero, where a line through them would be.
LightBlock interpolate(const IrradianceRecords& records, std::size_t receiver, std::span<const LightBlock> of_records);

}  // namespace chiaro::inverse

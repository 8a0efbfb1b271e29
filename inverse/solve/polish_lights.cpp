#include "inverse/solve/polish_lights.h"

#include "inverse/transport/gather_operator.h"

namespace chiaro::inverse {
namespace {

constexpr int kMostRounds = 4;
constexpr int kSamplesFactor = 4;     // gather rays per receiver, over those of the bake
constexpr int kPointsPerSample = 16;  // gather points over rays
constexpr double kAtRest = 2e-4;      // of the region's diagonal

// Columns with the indirect part computed at the very positions.
std::vector<Column> exact_columns(const TransportSource& transport, const GatherOperator& gather,
                                  const LightEstimates& lights) {
  std::vector<Vec3f> positions;
  for (const LightEstimate& l : lights) {
    positions.push_back({float(l.position.x()), float(l.position.y()), float(l.position.z())});
  }
  std::vector<Column> columns;
  for (std::size_t first = 0; first < lights.size(); first += kLightBlock) {
    const std::size_t count = std::min<std::size_t>(kLightBlock, lights.size() - first);
    const auto blocks = indirect_illumination(transport.tracer, gather, std::span(positions).subspan(first, count));
    for (std::size_t l = 0; l < count; ++l) {
      Column column = Column::Zero(Eigen::Index(transport.receivers.size()), 3);
      for (std::size_t i = 0; i < blocks.size(); ++i) {
        for (int c = 0; c < 3; ++c) column(Eigen::Index(i), c) = double(blocks[i].channel[c][l]);
      }
      columns.push_back(std::move(column));
    }
  }
  return columns;
}

double largest_move(const LightEstimates& a, const LightEstimates& b) {
  double move = 0;
  for (std::size_t j = 0; j < a.size(); ++j) move = std::max(move, (a[j].position - b[j].position).norm());
  return move;
}

}  // namespace

PolishedLights polish_lights(const TransportSource& transport, const LightResponse& response,
                             const Observations& observations, const LightEstimates& start) {
  PolishedLights result{start, 0, 0};
  const GatherOptions options{.samples = kSamplesFactor * transport.settings.samples,
                              .points_per_sample = kPointsPerSample,
                              .bounces = transport.settings.bounces,
                              .seed = transport.settings.seed};
  const GatherOperator gather = make_gather_operator(transport.tracer, transport.receivers, options);
  const double rest = kAtRest * double(response.grid().region.diagonal());
  for (double move = rest + 1; move > rest && result.rounds < kMostRounds; ++result.rounds) {
    JointRefinementOptions refinement;
    refinement.corrections = exact_columns(transport, gather, result.lights);
    for (std::size_t j = 0; j < result.lights.size(); ++j) {
      refinement.corrections[j] -= response.interpolated_indirect(result.lights[j].position);
    }
    JointRefinement refined = refine_joint(response, observations, result.lights, refinement);
    move = largest_move(refined.lights, result.lights);
    result.lights = std::move(refined.lights);
    result.error = refined.error;
  }
  return result;
}

}  // namespace chiaro::inverse

#include "inverse/solve/light_from_outside.h"

#include <algorithm>

#include "inverse/solve/insertion.h"
#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

using Eigen::Vector3d;

constexpr float kShells[] = {0.1F, 0.35F};  // off the region, in parts of its longest side
constexpr int kPerSide = 10;                // places along an edge of a shell's faces
constexpr std::size_t kMostPlaces = 64;     // whose indirect light is gathered
constexpr double kClearlyBetter = 0.9;      // of the error, or less
constexpr double kMatters = 0.25;           // of what the brightest of them brings

// All over the six faces of a box.
void add_places_on(const Box3f& box, std::vector<Vector3d>& places) {
  const Vec3f extent = box.extent();
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const float side : {0.0F, 1.0F}) {
      for (int k = 0; k < kPerSide * kPerSide; ++k) {
        Vec3f in_box;
        in_box[axis] = side;
        in_box[u] = (float(k % kPerSide) + 0.5F) / float(kPerSide);
        in_box[v] = (float(k / kPerSide) + 0.5F) / float(kPerSide);
        places.push_back(to_eigen(box.min + in_box * extent));
      }
    }
  }
}

std::vector<Vector3d> places_around(const Box3f& region) {
  std::vector<Vector3d> places;
  for (const float part : kShells) {
    const float by = part * max_component(region.extent());
    const Vec3f off{by, by, by};
    add_places_on({region.min - off, region.max + off}, places);
  }
  return places;
}

struct Outside {
  Vector3d position;
  Column column;  // direct light alone
  double gain = 0;
};

// Those whose direct light explains most of what is left.
std::vector<Outside> most_explaining(const LightResponse& response, const Observations& left) {
  const std::vector<Vector3d> places = places_around(response.grid().region);
  std::vector<Outside> outside(places.size());
  renderer::parallel_for(places.size(), [&](std::size_t k) {
    outside[k] = {places[k], response.direct(places[k])};
    LightEstimate light{places[k], Eigen::Array3d::Zero()};
    outside[k].gain = fit_intensity(left, outside[k].column, light);
  });
  std::erase_if(outside, [](const Outside& place) { return !(place.gain > 0); });
  std::stable_sort(outside.begin(), outside.end(), [](const auto& a, const auto& b) { return a.gain > b.gain; });
  if (outside.size() > kMostPlaces) outside.resize(kMostPlaces);
  return outside;
}

void add_indirect(const ExactIndirect& exact, std::vector<Outside>& outside) {
  std::vector<Vec3f> lights;
  for (const Outside& place : outside) lights.push_back(to_vec3f(place.position));
  const auto indirect = indirect_illumination_by_light(exact.tracer(), exact.gather(), lights);
  for (std::size_t k = 0; k < outside.size(); ++k) outside[k].column += column_of(indirect[k]);
}

std::vector<Vector3d> places_that_matter(const Observations& observations, const std::vector<Column>& columns,
                                         const LightEstimates& lights, std::size_t first) {
  std::vector<double> norm(lights.size(), 0.0);
  for (std::size_t j = first; j < lights.size(); ++j) {
    norm[j] = contribution_norm(observations, columns[j], lights[j].intensity);
  }
  const double least = kMatters * *std::max_element(norm.begin(), norm.end());
  std::vector<Vector3d> places;
  for (std::size_t j = first; j < lights.size(); ++j) {
    if (norm[j] > 0 && norm[j] >= least) places.push_back(lights[j].position);
  }
  return places;
}

}  // namespace

std::vector<Vector3d> find_light_from_outside(const LightResponse& response, const ExactIndirect& exact,
                                              const Observations& observations, const LightEstimates& found) {
  std::vector<Column> columns = evaluate_columns(response, found, Evaluation::kTracedVisibility);
  const Column inside = total_illumination(columns, found, Eigen::Index(response.receiver_count()));
  Observations left = observations;
  left.wanted -= inside;
  std::vector<Outside> outside = most_explaining(response, left);
  if (outside.empty()) return {};

  add_indirect(exact, outside);
  LightEstimates all = found;
  for (Outside& place : outside) {
    all.push_back({place.position, Eigen::Array3d::Zero()});
    columns.push_back(std::move(place.column));
  }
  const double error = refit_intensities(observations, columns, all);
  if (!(error < kClearlyBetter * relative_error(observations, inside))) return {};
  return places_that_matter(observations, columns, all, found.size());
}

}  // namespace chiaro::inverse

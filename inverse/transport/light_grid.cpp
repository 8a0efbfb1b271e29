#include "inverse/transport/light_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "renderer/core/control.h"
#include "renderer/core/error.h"
#include "renderer/core/world_limits.h"

namespace chiaro::inverse {
namespace {

using renderer::Error;

constexpr float kDefaultInset = 0.02F;      // of the scene's extent, on every side
constexpr float kThin = 0.1F;               // of the scene's longest side: lights stand so far before and behind it
constexpr float kInsideFraction = 0.6F;     // of probe rays that meet back faces, inside a solid
constexpr float kTouching = 0.02F;          // of the spacing
constexpr float kRandomClearance = 1e-3F;   // of the region's diagonal, and at most kTouching of where it is thin
constexpr std::uint32_t kMostTries = 1000;  // of random positions, for each
constexpr float kFlat = 1e-6F;              // of a node's diagonal: all of it is on its surface
constexpr int kMostHalvings = 2;            // of the spacing, where no node is free

// The 6 faces' and 8 corners' directions of a cube, turned a little so that they do not run along walls.
std::vector<Vec3f> probe_directions() {
  std::vector<Vec3f> directions;
  const auto turned = [](Vec3f d) {
    return normalize(d + 0.031F * Vec3f{d.y, d.z, -d.x} + Vec3f{0.007F, 0.011F, 0.013F});
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0F, 1.0F}) {
      Vec3f d;
      d[axis] = sign;
      directions.push_back(turned(d));
    }
  }
  for (int corner = 0; corner < 8; ++corner) {
    directions.push_back(turned({corner & 1 ? 1.0F : -1.0F, corner & 2 ? 1.0F : -1.0F, corner & 4 ? 1.0F : -1.0F}));
  }
  return directions;
}

struct Probe {
  float back_fraction = 0;
  float nearest = renderer::kInfinity, mean = renderer::kInfinity;  // distances, metres
};

Probe probe(const renderer::RayTracer& tracer, Vec3f position, const std::vector<Vec3f>& directions) {
  Probe result;
  double sum = 0;
  int hits = 0;
  for (const Vec3f& direction : directions) {
    const auto hit = tracer.intersect({position, direction, 0, renderer::kInfinity, 0});
    if (!hit) continue;
    const renderer::Instance& instance = tracer.scene().instances[hit->instance];
    const auto& material = tracer.scene().materials[tracer.scene().meshes[instance.mesh].material];
    const bool back = !material.double_sided && dot(hit->geometric_normal, direction) > 0;
    result.back_fraction += (back ? 1.0F : 0.0F) / float(directions.size());
    result.nearest = std::min(result.nearest, hit->distance);
    sum += double(hit->distance), ++hits;
  }
  if (hits > 0) result.mean = float(sum / hits);
  return result;
}

std::array<int, 3> counts_for(Vec3f extent, double lights) {
  // Spacing from the volume; a flat or thin region counts as a plane or a line.
  double volume = 1;
  int dimensions = 0;
  const double longest = renderer::max_component(extent);
  for (int a = 0; a < 3; ++a) {
    if (extent[a] > 0.02 * longest) volume *= double(extent[a]), ++dimensions;
  }
  const double spacing = dimensions > 0 ? std::pow(volume / lights, 1.0 / dimensions) : 1;
  std::array<int, 3> counts{};
  for (int a = 0; a < 3; ++a) {
    counts[a] = extent[a] > 0.02 * longest ? std::max(1, int(std::lround(double(extent[a]) / spacing))) : 1;
  }
  return counts;
}

LightGrid empty_grid(const Box3f& region, const std::array<int, 3>& counts) {
  LightGrid grid;
  grid.region = region;
  grid.counts = counts;
  for (int a = 0; a < 3; ++a) {
    grid.spacing[a] = region.extent()[a] / float(counts[a]);
    grid.origin[a] = region.min[a] + 0.5F * grid.spacing[a];
  }
  return grid;
}

Vec3f node_position(const LightGrid& grid, std::size_t node) {
  const std::size_t x = node % grid.counts[0], y = node / grid.counts[0] % grid.counts[1];
  const std::size_t z = node / grid.counts[0] / grid.counts[1];
  return grid.origin + grid.spacing * Vec3f{float(x), float(y), float(z)};
}

// Whether so many cells around a node have a part of the region in them; of no parts, they have.
bool cell_touches(const LightGrid& grid, Vec3f node, const std::vector<Box3f>& parts, float cells) {
  const Vec3f half = 0.5F * cells * grid.spacing;
  const auto touches = [&](const Box3f& part) {
    return !Box3f{max(part.min, node - half), min(part.max, node + half)}.empty();
  };
  return parts.empty() || std::any_of(parts.begin(), parts.end(), touches);
}

bool looks_inside(const Probe& p) { return p.back_fraction >= kInsideFraction; }

// Whether the sides of the scene's surfaces tell inside from outside. Where almost all of the scene looks like the
// inside of a solid, its walls are turned outwards, and they do not.
bool sides_tell(const renderer::RayTracer& tracer, const std::vector<Vec3f>& directions) {
  const LightGrid probes = empty_grid(default_region(tracer), {8, 8, 8});
  int inside = 0;
  for (std::size_t i = 0; i < 512; ++i) {
    if (looks_inside(probe(tracer, node_position(probes, i), directions))) ++inside;
  }
  return inside < 460;
}

float least_positive(Vec3f v) {
  float least = renderer::kInfinity;
  for (int a = 0; a < 3; ++a) {
    if (v[a] > 0) least = std::min(least, v[a]);
  }
  return least == renderer::kInfinity ? 0 : least;
}

// Lights at the nodes in free space that have a part of the region in so many cells around them.
void place_lights(LightGrid& grid, const FreeSpace& free_space, const std::vector<Box3f>& parts, float cells,
                  const renderer::Control& control) {
  const std::size_t nodes = std::size_t(grid.counts[0]) * grid.counts[1] * grid.counts[2];
  const float touching = kTouching * least_positive(grid.spacing);
  std::vector<char> free(nodes);
  renderer::parallel_for(nodes, "", control, [&](std::size_t i) {
    const Vec3f position = node_position(grid, i);
    free[i] = cell_touches(grid, position, parts, cells) && free_space.contains(position, touching) ? 1 : 0;
  });
  grid.light_of_node.assign(nodes, -1);
  for (std::size_t i = 0; i < nodes; ++i) {
    if (free[i] == 0) continue;
    grid.light_of_node[i] = int(grid.positions.size());
    grid.positions.push_back(node_position(grid, i));
  }
}

LightGrid filled_grid(const Box3f& region, const std::array<int, 3>& counts, const std::vector<Box3f>& parts,
                      const FreeSpace& free_space, const renderer::Control& control) {
  LightGrid grid = empty_grid(region, counts);
  place_lights(grid, free_space, parts, 1, control);
  // Small parts beside solids: their neighbours.
  const int most = parts.empty() ? 1 : 2 * *std::max_element(counts.begin(), counts.end());
  for (int cells = 3; grid.positions.empty() && cells < 2 * most; cells *= 2) {
    place_lights(grid, free_space, parts, float(cells), control);
  }
  return grid;
}

// Twice as many on every axis on which the region has an extent.
std::array<int, 3> finer(std::array<int, 3> counts, Vec3f extent) {
  for (int a = 0; a < 3; ++a) counts[a] *= extent[a] > 0 ? 2 : 1;
  return counts;
}

std::optional<Box3f> six_numbers(const std::string& text) {
  std::array<float, 6> v{};
  const char* at = text.data();
  const char* end = at + text.size();
  for (std::size_t i = 0; i < 6; ++i) {
    const auto [next, code] = std::from_chars(at, end, v[i]);
    if (code != std::errc() || !std::isfinite(v[i])) return std::nullopt;
    at = next;
    if (i < 5 && (at == end || *at++ != ',')) return std::nullopt;
  }
  if (at != end) return std::nullopt;
  const Vec3f a{v[0], v[1], v[2]}, b{v[3], v[4], v[5]};
  return Box3f{min(a, b), max(a, b)};
}

}  // namespace

Box3f default_region(const renderer::RayTracer& tracer) {
  Box3f region = tracer.bounds();
  const Vec3f extent = region.extent();
  const float thin = kThin * max_component(extent);
  for (int a = 0; a < 3; ++a) {
    const float outwards = extent[a] < thin ? thin : -kDefaultInset * extent[a];
    region.min[a] -= outwards;
    region.max[a] += outwards;
  }
  return region;
}

GridCell cell_of(const LightGrid& grid, const LightGrid::FinerCell& finer) {
  const std::uint64_t nx = std::uint64_t(grid.counts[0]) << finer.level;
  const std::uint64_t ny = std::uint64_t(grid.counts[1]) << finer.level;
  const std::uint64_t x = finer.number % nx, y = finer.number / nx % ny, z = finer.number / nx / ny;
  return {finer.level, {std::uint32_t(x), std::uint32_t(y), std::uint32_t(z)}};
}

std::uint64_t number_of(const LightGrid& grid, const GridCell& cell) {
  const std::uint64_t nx = std::uint64_t(grid.counts[0]) << cell.level;
  const std::uint64_t ny = std::uint64_t(grid.counts[1]) << cell.level;
  return cell.at[0] + nx * (cell.at[1] + ny * cell.at[2]);
}

Box3f bounds_of(const LightGrid& grid, const GridCell& cell) {
  const Vec3f size = grid.spacing / float(1 << cell.level);
  const Vec3f low = grid.region.min + size * Vec3f{float(cell.at[0]), float(cell.at[1]), float(cell.at[2])};
  return {low, low + size};
}

std::size_t node_of(const LightGrid& grid, const GridCell& cell) {
  return number_of(grid, {0, {cell.at[0] >> cell.level, cell.at[1] >> cell.level, cell.at[2] >> cell.level}});
}

void set_finer_cells(LightGrid& grid, std::vector<LightGrid::FinerCell> cells) {
  grid.positions.resize(grid.node_light_count());
  grid.finer = std::move(cells);
  for (const LightGrid::FinerCell& finer : grid.finer) {
    const Box3f bounds = bounds_of(grid, cell_of(grid, finer));
    grid.positions.push_back(bounds.min + 0.5F * bounds.extent());
  }
}

FreeSpace::FreeSpace(const renderer::RayTracer& tracer)
    : tracer_(tracer), directions_(probe_directions()), sides_tell_(sides_tell(tracer, directions_)) {}

bool FreeSpace::contains(Vec3f position, float clearance) const {
  const Probe at = probe(tracer_, position, directions_);
  return !(sides_tell_ && looks_inside(at)) && at.nearest >= clearance;
}

float FreeSpace::mean_distance(Vec3f position) const { return probe(tracer_, position, directions_).mean; }

LightGrid make_light_grid(const renderer::RayTracer& tracer, const LightGridOptions& options,
                          const renderer::Control& control) {
  const renderer::Control quiet = control.without_progress();
  const Box3f region = options.region.value_or(default_region(tracer));
  const bool is_given = options.counts[0] > 0;
  std::array<int, 3> counts = is_given ? options.counts : counts_for(region.extent(), options.lights);
  const FreeSpace free_space(tracer);
  LightGrid grid = filled_grid(region, counts, options.parts, free_space, quiet);
  // A thin region that a solid nearly fills has its free space between such nodes.
  for (int halvings = 0; grid.positions.empty() && !is_given && halvings < kMostHalvings; ++halvings) {
    counts = finer(counts, region.extent());
    grid = filled_grid(region, counts, options.parts, free_space, quiet);
  }
  if (grid.positions.empty()) {
    throw NoUsableGrid({tracer.scene().path, "light grid",
                        "no light possible: every position lies inside a solid, or on a surface",
                        "a region with free space, by --region"});
  }
  return grid;
}

Vec3f random_position(const Box3f& box, renderer::Sampler& sampler) {
  const renderer::Vec2f xy = sampler.next_2d();
  return box.min + box.extent() * Vec3f{xy.x, xy.y, sampler.next_1d()};
}

std::vector<Vec3f> random_light_positions(const renderer::RayTracer& tracer, const Box3f& region, std::size_t count,
                                          std::uint64_t seed) {
  const FreeSpace free_space(tracer);
  const float clearance = std::min(kRandomClearance * region.diagonal(), kTouching * least_positive(region.extent()));
  std::vector<Vec3f> positions;
  for (std::uint32_t i = 0; positions.size() < count && i < kMostTries * count; ++i) {
    renderer::Sampler sampler(seed, 0, i);
    const Vec3f position = random_position(region, sampler);
    if (free_space.contains(position, clearance)) positions.push_back(position);
  }
  return positions;
}

void refuse(const renderer::Scene& scene, const AskedIn& asked_in, const std::string& problem,
            const std::string& expected) {
  throw Error({asked_in.file.empty() ? scene.path : asked_in.file, asked_in.place, problem, expected});
}

Box3f parse_region(const renderer::Scene& scene, const Region& region) {
  const auto& [text, asked_in] = region;
  if (const auto box = six_numbers(text)) {
    const bool within = renderer::in_world(box->min) && renderer::in_world(box->max);
    if (within && box->diagonal() > 0) return *box;
    refuse(scene, asked_in, within ? "is a single point" : "reaches too far",
           fmt::format("a box of some extent, within {:g} m of the origin", renderer::kWorldLimit));
  }
  const Box3f box = renderer::bounds_of_node(scene, text);
  if (box.empty()) {
    refuse(scene, asked_in, fmt::format("no node with a mesh, or above one, is named \"{}\"", text),
           "a node's name, or x0,y0,z0,x1,y1,z1 in metres");
  }
  if (!(min_component(box.extent()) > kFlat * box.diagonal())) {
    refuse(scene, asked_in, fmt::format("node \"{}\" is flat, so that all places in it are on it", text),
           "a node of some extent along x, y and z; --on-surface is for lights in front of one");
  }
  return box;
}

}  // namespace chiaro::inverse

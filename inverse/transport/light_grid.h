#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "renderer/core/control.h"
#include "renderer/core/error.h"
#include "renderer/core/sampler.h"
#include "renderer/trace/ray_tracer.h"

namespace chiaro::inverse {

using renderer::Box3f;
using renderer::Vec3f;

// Candidate light positions in the middle of the cells of a regular grid over a region, x fastest, and of parts of
// cells where transport changes fast.
struct LightGrid {
  Box3f region;                    // where lights may stand
  Vec3f origin;                    // of node (0, 0, 0), metres
  Vec3f spacing;                   // metres
  std::array<int, 3> counts{};     // nodes along x, y, z
  std::vector<int> light_of_node;  // index into positions, -1: left out (inside a solid)
  // A cell of the grid with all cells halved `level` times, x fastest.
  struct FinerCell {
    int level = 1;
    std::uint64_t number = 0;
    auto operator<=>(const FinerCell&) const = default;
  };
  std::vector<FinerCell> finer;  // that have a light of their own; ascending
  std::vector<Vec3f> positions;  // of the lights kept, in the order of their nodes, then of `finer`

  std::size_t node_light_count() const { return positions.size() - finer.size(); }
};

inline constexpr int kMostLevels = 3;  // of finer cells

// Whole cells are those of level 0.
struct GridCell {
  int level = 0;
  std::array<std::uint32_t, 3> at{};  // along x, y and z
};
GridCell cell_of(const LightGrid& grid, const LightGrid::FinerCell& finer);
std::uint64_t number_of(const LightGrid& grid, const GridCell& cell);
Box3f bounds_of(const LightGrid& grid, const GridCell& cell);
// The whole cell that it is part of.
std::size_t node_of(const LightGrid& grid, const GridCell& cell);

// Gives these cells, ascending, lights of their own in place of all finer cells that the grid had.
void set_finer_cells(LightGrid& grid, std::vector<LightGrid::FinerCell> cells);

// The scene's bounds, a little inside, but on both sides of what is flat.
Box3f default_region(const renderer::RayTracer& tracer);

// Lights may stand nowhere in a region, or nowhere that a grid of as many as there may be does justice to.
class NoUsableGrid : public renderer::Error {
 public:
  using Error::Error;
};

struct LightGridOptions {
  // 0, 0, 0: from the region's shape, for about so many nodes as `lights` says; more where none of them is free.
  std::array<int, 3> counts{};
  std::optional<Box3f> region = {};  // absent: default_region()
  std::vector<Box3f> parts = {};     // of the region, the only ones of interest; none: all of it
  double lights = 700;
  double error = 0;  // of interpolation, for choose_light_grid(); 0: whatever comes of the above
};

// Where a light may stand: not inside a solid.
class FreeSpace {
 public:
  // Keeps a reference to the tracer.
  explicit FreeSpace(const renderer::RayTracer& tracer);
  // No surface nearer than `clearance` (metres), as far as a few rays tell.
  bool contains(Vec3f position, float clearance) const;
  // Mean distance of the surfaces around, metres; infinite where there are none.
  float mean_distance(Vec3f position) const;

 private:
  const renderer::RayTracer& tracer_;
  std::vector<Vec3f> directions_;
  bool sides_tell_;  // of the scene's surfaces, inside from outside
};

// Nodes inside solids, those that touch a surface, and those whose cells lie outside all parts, are left out. Error
// where none is left ("no light possible"). control: to be interrupted.
LightGrid make_light_grid(const renderer::RayTracer& tracer, const LightGridOptions& options,
                          const renderer::Control& control = {});

// Anywhere in the box, by the sampler's next three numbers.
Vec3f random_position(const Box3f& box, renderer::Sampler& sampler);

// Evenly distributed over the free space of the region. Fewer where there is hardly any.
std::vector<Vec3f> random_light_positions(const renderer::RayTracer& tracer, const Box3f& region, std::size_t count,
                                          std::uint64_t seed);

// Where something was asked for, for messages: a file and the place in it, or no file and an option.
struct AskedIn {
  std::string file, place;
};

// Error there; of an option, naming the scene that it was given for.
[[noreturn]] void refuse(const renderer::Scene& scene, const AskedIn& asked_in, const std::string& problem,
                         const std::string& expected);

struct Region {
  std::string text;  // the name of a node, or "x0,y0,z0,x1,y1,z1", metres
  AskedIn asked_in{"", "option --region"};
};

// The world bounds of a node's instances, or the box. Error naming what is wrong.
Box3f parse_region(const renderer::Scene& scene, const Region& region);

}  // namespace chiaro::inverse

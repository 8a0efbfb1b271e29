#include "inverse/target/lightmap.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "inverse/target/texel_coverage.h"
#include "renderer/core/error.h"
#include "renderer/core/world_limits.h"

namespace chiaro::inverse {
namespace {

using renderer::Error;
using renderer::Instance;
using renderer::Mesh;
using renderer::Scene;
using renderer::Triangle;

constexpr std::size_t kMostNames = 20;

// A triangle of the world; where the texels lie on it.
class PlacedTriangle {
 public:
  PlacedTriangle(const Mesh& mesh, const Triangle& triangle, const Instance& instance) {
    Vec3f side;
    for (int k = 0; k < 3; ++k) {
      corners_[k] = transform_point(instance.world_from_object, mesh.positions[triangle[k]]);
      side += transform_normal(instance.world_from_object, mesh.normals[triangle[k]]);
    }
    const Vec3f flat = cross(corners_[1] - corners_[0], corners_[2] - corners_[0]);
    area_ = length(flat) / 2;
    if (area_ > 0) normal_ = normalize(dot(flat, side) < 0 ? -flat : flat);
  }

  float area() const { return area_; }
  Vec3f normal() const { return normal_; }
  Vec3f at(const Barycentric& b) const {
    return float(b[0]) * corners_[0] + float(b[1]) * corners_[1] + float(b[2]) * corners_[2];
  }

 private:
  std::array<Vec3f, 3> corners_;
  Vec3f normal_;
  float area_ = 0;
};

[[noreturn]] void no_such_node(const Scene& scene, const std::string& name) {
  std::set<std::string> names;
  for (const Instance& instance : scene.instances) names.insert(instance.name);
  const std::size_t shown = std::min(names.size(), kMostNames);
  const std::string list = fmt::format("{}", fmt::join(names.begin(), std::next(names.begin(), long(shown)), ", "));
  throw Error({scene.path, "nodes", fmt::format("no node '{}' that shows a mesh", name),
               fmt::format("one of: {}{}", list, shown < names.size() ? ", …" : "")});
}

// By mesh, in the order of the instances.
using Copies = std::map<int, std::vector<const Instance*>>;

Copies copies_of(const Scene& scene, const std::string& name) {
  Copies copies;
  for (const Instance& instance : scene.instances) {
    if (instance.name == name) copies[instance.mesh].push_back(&instance);
  }
  if (copies.empty()) no_such_node(scene, name);
  return copies;
}

bool all_have(const Scene& scene, const Copies& copies, int uv_set) {
  return std::all_of(copies.begin(), copies.end(), [&](const auto& copy) {
    return !scene.meshes[std::size_t(copy.first)].uv[std::size_t(uv_set)].empty();
  });
}

int choose_uv_set(const Scene& scene, const Copies& copies, const Lightmap& map) {
  const int chosen = map.uv_set.value_or(all_have(scene, copies, 1) ? 1 : 0);
  if (all_have(scene, copies, chosen)) return chosen;
  std::vector<std::string> sets;
  for (int n = 0; n < renderer::kUvSetCount; ++n) {
    if (all_have(scene, copies, n)) sets.push_back(fmt::format("TEXCOORD_{}", n));
  }
  throw Error({scene.path, fmt::format("node '{}'", map.node), fmt::format("has no TEXCOORD_{} all over", chosen),
               sets.empty() ? "texture coordinates for the lightmap"
                            : fmt::format("--lightmap-uv for one of: {}", fmt::join(sets, ", "))});
}

// Whether the texel is used; else it is counted.
bool is_used(const Lightmap& map, std::size_t texel, const TexelCover& cover, TexelCounts& counts) {
  const Vec3f value = map.texels[texel];
  std::size_t* why = nullptr;
  if (cover.mesh < 0) {
    why = &counts.empty;
  } else if (cover.overlapping) {
    why = &counts.overlapping;
  } else if (!(map.weight[texel] > 0)) {
    why = &counts.masked;
  } else if (!renderer::is_light(value)) {
    why = &counts.invalid;
  }
  ++*(why ? why : &counts.used);
  return !why;
}

// One per copy.
class TexelValues {
 public:
  TexelValues(const Scene& scene, const Lightmap& map, const TexelLayout& layout, const Copies& copies)
      : scene_(scene), map_(map), layout_(layout), copies_(copies) {}

  void add(std::size_t texel, const TexelCover& cover, LightmapValues& result) const {
    const Mesh& mesh = scene_.meshes[std::size_t(cover.mesh)];
    const FlatTriangle flat(mesh, cover.triangle, layout_);
    const std::size_t width = std::size_t(map_.width);
    const Barycentric at = flat.at(double(texel % width) + 0.5, double(texel / width) + 0.5);
    for (const Instance* instance : copies_.at(cover.mesh)) {
      const PlacedTriangle placed(mesh, mesh.triangles[cover.triangle], *instance);
      if (!(placed.area() > 0)) continue;
      const double area = double(placed.area()) / std::abs(flat.signed_area());
      result.area += area;
      result.values.push_back({placed.at(at), placed.normal(), map_.texels[texel], float(area) * map_.weight[texel]});
    }
  }

 private:
  const Scene& scene_;
  const Lightmap& map_;
  TexelLayout layout_;
  const Copies& copies_;
};

}  // namespace

LightmapValues values_of_lightmap(const Scene& scene, const Lightmap& map) {
  CHIARO_CHECK(map.texels.size() == std::size_t(map.width) * std::size_t(map.height));
  CHIARO_CHECK(map.weight.size() == map.texels.size());
  const Copies copies = copies_of(scene, map.node);
  const TexelLayout layout{map.width, map.height, choose_uv_set(scene, copies, map)};
  LightmapValues result;
  result.uv_set = layout.uv_set;
  std::vector<int> meshes;
  for (const auto& [mesh, placed] : copies) {
    meshes.push_back(mesh);
    result.copies = std::max(result.copies, placed.size());
  }
  const TexelCoverage coverage = cover_texels(scene, meshes, layout);
  result.triangles_outside = coverage.triangles_outside;
  const TexelValues values(scene, map, layout, copies);
  for (std::size_t i = 0; i < map.texels.size(); ++i) {
    if (is_used(map, i, coverage.texels[i], result.counts)) values.add(i, coverage.texels[i], result);
  }
  return result;
}

}  // namespace chiaro::inverse

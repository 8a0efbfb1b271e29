#include "renderer/io/mesh_tangents.h"

#include <numeric>

#include "renderer/io/mesh_vertices.h"
#include "renderer/io/mikktspace.h"

namespace chiaro::renderer {
namespace {

constexpr std::uint32_t kNone = ~0U;

bool same(Vec4f a, Vec4f b) { return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w; }

// Hands out vertices by the tangent that they carry.
class VertexCopies {
 public:
  explicit VertexCopies(std::size_t vertices) : tangents_(vertices), next_(vertices, kNone), taken_(vertices, false) {
    sources_.resize(vertices);
    std::iota(sources_.begin(), sources_.end(), 0U);
  }

  std::uint32_t with_tangent(std::uint32_t vertex, Vec4f tangent) {
    if (!taken_[vertex]) {
      taken_[vertex] = true;
      tangents_[vertex] = tangent;
      return vertex;
    }
    std::uint32_t last = vertex;
    for (std::uint32_t v = vertex; v != kNone; v = next_[v]) {
      if (same(tangents_[v], tangent)) return v;
      last = v;
    }
    next_[last] = std::uint32_t(sources_.size());
    sources_.push_back(vertex);
    tangents_.push_back(tangent);
    next_.push_back(kNone);
    return next_[last];
  }

  const std::vector<std::uint32_t>& sources() const { return sources_; }
  std::vector<Vec4f> take_tangents() { return std::move(tangents_); }

 private:
  std::vector<Vec4f> tangents_;
  std::vector<std::uint32_t> next_, sources_;
  std::vector<bool> taken_;
};

}  // namespace

void make_tangents(Mesh& mesh, int uv_set) {
  const std::vector<Vec4f> corners =
      mikktspace_tangents(mesh.positions, mesh.normals, mesh.uv[std::size_t(uv_set)], mesh.triangles);
  VertexCopies copies(mesh.positions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      // v grows downwards in the picture, and the bitangent of glTF points upwards.
      Vec4f tangent = corners[3 * t + c];
      tangent.w = -tangent.w;
      mesh.triangles[t][c] = copies.with_tangent(mesh.triangles[t][c], tangent);
    }
  }
  mesh.tangents.clear();
  if (copies.sources().size() > mesh.positions.size()) gather_vertices(mesh, copies.sources());
  mesh.tangents = copies.take_tangents();
}

}  // namespace chiaro::renderer

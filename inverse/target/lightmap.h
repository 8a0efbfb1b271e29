#pragma once
// Illumination in a picture laid out by texture coordinates, as engines bake it, as wanted illumination of the surface.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "inverse/target/target_from_values.h"
#include "renderer/scene/scene.h"

namespace chiaro::inverse {

struct Lightmap {
  std::string node;           // whose surface it shows; of several of that name, each
  std::optional<int> uv_set;  // n of TEXCOORD_n; absent: 1 where all meshes of the node have it, else 0
  int width = 0, height = 0;
  std::vector<Vec3f> texels;  // illumination: scene-linear Rec.709, cd/m², rows from the top, which is v = 0
  std::vector<float> weight;  // per texel, 0 to 1: how much it counts
};

// What became of the texels. All but `used` weigh nothing.
struct TexelCounts {
  std::size_t used = 0;
  std::size_t empty = 0;        // centre in no triangle
  std::size_t overlapping = 0;  // centre in several triangles: of one of them, who knows which
  std::size_t masked = 0;       // weight 0 already
  std::size_t invalid = 0;      // not finite, or negative
};

struct LightmapValues {
  std::vector<SurfaceValue> values;  // weight: m² of the surface that a texel covers, times the texel's own
  TexelCounts counts;
  double area = 0;  // m², that the texels used cover
  int uv_set = 0;
  std::size_t copies = 0;             // of the node's meshes, in the world
  std::size_t triangles_outside = 0;  // whose coordinates leave 0 to 1, where lightmaps do not go on: left out
};

// One value for every texel whose centre lies in one triangle of the node, at that place, on the side of the vertex
// normals. Error naming the choices where no node of that name shows a mesh, or a mesh lacks the coordinates.
LightmapValues values_of_lightmap(const renderer::Scene& scene, const Lightmap& lightmap);

}  // namespace chiaro::inverse

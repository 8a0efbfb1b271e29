#include "renderer/scene/texture_mip_maps.h"

#include <optional>

#include "renderer/core/control.h"
#include "renderer/image/mip_maps.h"

namespace chiaro::renderer {
namespace {

using Uses = std::vector<std::optional<MipOptions>>;  // per texture

// A texture of two uses is averaged for the first.
void add(Uses& uses, const TextureUse& use, const MipOptions& options) {
  if (use.texture >= 0 && !uses[use.texture]) uses[use.texture] = options;
}

void add_uses(Uses& uses, const Material& m) {
  if (!m.constant_base_color) {
    add(uses, m.base_color_texture, {.srgb = true, .alpha_weighted = m.alpha_mode != AlphaMode::kOpaque});
  }
  add(uses, m.emission_texture, {.srgb = true});
  add(uses, m.normal_texture, {});
  if (!m.lambert) add(uses, m.metallic_roughness_texture, {});
}

}  // namespace

void make_mip_maps(Scene& scene) {
  Uses uses(scene.textures.size());
  for (const Mesh& mesh : scene.meshes) add_uses(uses, scene.materials[mesh.material]);
  parallel_for(uses.size(), [&](std::size_t i) {
    if (uses[i] && !scene.textures[i].filtered_as_stored) make_mip_maps(scene.textures[i], *uses[i]);
  });
}

}  // namespace chiaro::renderer

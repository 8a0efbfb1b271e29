#include "renderer/scene/texture_mip_maps.h"

#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include "renderer/core/control.h"
#include "renderer/image/mip_maps.h"

namespace chiaro::renderer {
namespace {

template <class Channel>
bool all_opaque(const std::vector<Channel>& rgba) {
  for (std::size_t i = 3; i < rgba.size(); i += 4) {
    if (rgba[i] != std::numeric_limits<Channel>::max()) return false;
  }
  return true;
}

// Gives every way to average a texture a texture of its own: the first the one that is there, the others copies.
class MippedTextures {
 public:
  explicit MippedTextures(std::vector<Texture>& textures) : textures_(textures), options_(textures.size()) {}

  void add(TextureUse& use, MipOptions options) {
    if (use.texture < 0 || textures_[use.texture].filtered_as_stored) return;
    const Texture& texture = textures_[use.texture];
    if (options.alpha_weighted) {
      options.alpha_weighted = !all_opaque(texture.rgba) || !all_opaque(texture.wide_rgba);
    }
    const auto [known, is_new] =
        by_use_.try_emplace({use.texture, options.srgb, options.alpha_weighted, options.wide}, use.texture);
    if (is_new && options_[use.texture]) {
      known->second = int(textures_.size());
      textures_.push_back(Texture(texture));
      options_.emplace_back();
    }
    use.texture = known->second;
    options_[use.texture] = options;
  }

  void make(const Control& control) {
    parallel_for(textures_.size(), "mip maps", control, [&](std::size_t i) {
      if (options_[i]) make_mip_maps(textures_[i], *options_[i]);
    });
  }

 private:
  std::vector<Texture>& textures_;
  std::vector<std::optional<MipOptions>> options_;
  std::map<std::tuple<int, bool, bool, bool>, int> by_use_;
};

void add_uses(MippedTextures& textures, Material& m) {
  if (!m.constant_base_color) {
    textures.add(m.base_color_texture, {.srgb = true, .alpha_weighted = m.alpha_mode != AlphaMode::kOpaque});
  }
  textures.add(m.emission_texture, {.srgb = true, .wide = true});
  textures.add(m.normal_texture, {});
  if (!m.lambert) textures.add(m.metallic_roughness_texture, {});
}

}  // namespace

void make_mip_maps(Scene& scene, const Control& control) {
  std::vector<bool> drawn(scene.materials.size());
  for (const Mesh& mesh : scene.meshes) drawn[std::size_t(mesh.material)] = true;
  MippedTextures textures(scene.textures);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    if (drawn[i]) add_uses(textures, scene.materials[i]);
  }
  textures.make(control.without_progress());
}

}  // namespace chiaro::renderer

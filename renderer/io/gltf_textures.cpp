#include "renderer/io/gltf_textures.h"

#include <algorithm>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "renderer/core/control.h"
#include "renderer/core/error.h"
#include "renderer/image/image_file.h"
#include "renderer/io/gltf_uri.h"

namespace chiaro::renderer {
namespace {

Wrap wrap_of(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::kClampToEdge;
  return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::kMirroredRepeat : Wrap::kRepeat;
}

int image_of(const tinygltf::Texture& texture) {
  for (const char* extension : {"EXT_texture_avif", "EXT_texture_webp"}) {
    const auto found = texture.extensions.find(extension);
    if (found != texture.extensions.end()) return found->second.Get("source").GetNumberAsInt();
  }
  return texture.source;
}

std::string label_of(const GltfDocument& document, int image) {
  const GltfImageSource& source = document.json.images[image];
  const bool has_file_name = source.uri && !is_data_uri(*source.uri);
  const std::string name = has_file_name ? *source.uri : source.name;
  return name.empty() ? fmt::format("images[{}]", image) : fmt::format("images[{}] \"{}\"", image, name.substr(0, 200));
}

Texture decode(const GltfDocument& document, int image) {
  const std::string label = label_of(document, image);
  try {
    return decode_texture(image_bytes(document, image), label);
  } catch (const Error& error) {
    if (error.parts().file != label) throw;
    fail(document, label, error.parts().problem, error.parts().expected);
  }
}

}  // namespace

int GltfTextureList::add(const GltfDocument& document, int texture, const std::string& place,
                         std::vector<std::string>& warnings) {
  const tinygltf::Texture& source = document.model->textures[texture];
  Entry entry;
  entry.image = image_of(source);
  if (entry.image < 0) {
    warnings.push_back(fmt::format("{}: textures[{}] has no image that is read here; left out", place, texture));
    return -1;
  }
  if (source.sampler >= 0) {
    const tinygltf::Sampler& sampler = document.model->samplers[source.sampler];
    entry.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    entry.wrap_u = wrap_of(sampler.wrapS);
    entry.wrap_v = wrap_of(sampler.wrapT);
  }
  const auto found = std::find(entries_.begin(), entries_.end(), entry);
  if (found != entries_.end()) return int(found - entries_.begin());
  entries_.push_back(entry);
  return int(entries_.size()) - 1;
}

std::vector<Texture> decode_textures(const GltfDocument& document, const GltfTextureList& list) {
  std::vector<int> images;
  for (const auto& entry : list.entries()) images.push_back(entry.image);
  std::sort(images.begin(), images.end());
  images.erase(std::unique(images.begin(), images.end()), images.end());
  std::vector<Texture> decoded(images.size());
  parallel_for(images.size(), [&](std::size_t i) { decoded[i] = decode(document, images[i]); });
  std::vector<Texture> textures;
  for (const auto& entry : list.entries()) {
    const auto image = std::lower_bound(images.begin(), images.end(), entry.image) - images.begin();
    textures.push_back(decoded[image]);
    textures.back().nearest = entry.nearest;
    textures.back().wrap_u = entry.wrap_u;
    textures.back().wrap_v = entry.wrap_v;
  }
  return textures;
}

}  // namespace chiaro::renderer

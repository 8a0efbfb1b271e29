#include "renderer/io/gltf_textures.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "renderer/core/error.h"
#include "renderer/core/shortened.h"
#include "renderer/image/image_file.h"
#include "renderer/io/gltf_uri.h"

namespace chiaro::renderer {
namespace {

Wrap wrap_of(const GltfDocument& document, int sampler, const char* name, int mode) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return Wrap::kClampToEdge;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return Wrap::kMirroredRepeat;
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return Wrap::kRepeat;
    default:
      fail(document, fmt::format("samplers[{}].{}", sampler, name), fmt::format("is {}", mode),
           "33071 (to the edge), 33648 (mirrored) or 10497 (repeated)");
  }
}

int image_of(const tinygltf::Texture& texture) {
  for (const char* extension : {"EXT_texture_avif", "EXT_texture_webp"}) {
    const auto found = texture.extensions.find(extension);
    if (found != texture.extensions.end()) return found->second.Get("source").GetNumberAsInt();
  }
  return texture.source;
}

// The first of images with the same bytes, of which exporters write one for every use.
int first_alike(const GltfDocument& document, int image) {
  const std::vector<GltfImageSource>& images = document.json.images;
  const GltfImageSource& source = images[std::size_t(image)];
  const auto alike = [&](const GltfImageSource& other) {
    return source.uri ? other.uri == source.uri
                      : source.buffer_view >= 0 && !other.uri && other.buffer_view == source.buffer_view;
  };
  const auto first = std::find_if(images.begin(), images.end(), alike);
  return first == images.end() ? image : int(first - images.begin());
}

std::string label_of(const GltfDocument& document, int image) {
  const GltfImageSource& source = document.json.images[image];
  const bool has_file_name = source.uri && !is_data_uri(*source.uri);
  const std::string name = has_file_name ? *source.uri : source.name;
  return name.empty() ? fmt::format("images[{}]", image)
                      : fmt::format("images[{}] \"{}\"", image, shortened(name, 200));
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
  entry.image = first_alike(document, entry.image);
  if (source.sampler >= 0) {
    const tinygltf::Sampler& sampler = document.model->samplers[source.sampler];
    entry.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    entry.wrap_u = wrap_of(document, source.sampler, "wrapS", sampler.wrapS);
    entry.wrap_v = wrap_of(document, source.sampler, "wrapT", sampler.wrapT);
  }
  const auto found = std::find(entries_.begin(), entries_.end(), entry);
  if (found != entries_.end()) return int(found - entries_.begin());
  entries_.push_back(entry);
  return int(entries_.size()) - 1;
}

std::vector<Texture> decode_textures(const GltfDocument& document, const GltfTextureList& list,
                                     const Control& control) {
  const std::vector<GltfTextureList::Entry>& entries = list.entries();
  std::map<int, std::vector<std::size_t>> of_image;  // entries
  for (std::size_t k = 0; k < entries.size(); ++k) of_image[entries[k].image].push_back(k);
  std::vector<Texture> textures(entries.size());
  std::vector<std::size_t> first;
  for (const auto& [image, uses] : of_image) first.push_back(uses.front());
  parallel_for(first.size(), "textures", control.without_progress(),
               [&](std::size_t k) { textures[first[k]] = decode(document, entries[first[k]].image); });
  for (const auto& [image, uses] : of_image) {
    for (std::size_t k = 1; k < uses.size(); ++k) textures[uses[k]] = textures[uses.front()];
  }
  for (std::size_t k = 0; k < entries.size(); ++k) {
    textures[k].nearest = entries[k].nearest;
    textures[k].wrap_u = entries[k].wrap_u;
    textures[k].wrap_v = entries[k].wrap_v;
  }
  return textures;
}

}  // namespace chiaro::renderer

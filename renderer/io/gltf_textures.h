#pragma once
// Textures: images with the way they are sampled.

#include <string>
#include <vector>

#include "renderer/core/control.h"
#include "renderer/image/texture.h"
#include "renderer/io/gltf_document.h"

namespace chiaro::renderer {

// The textures that a scene needs, each pair of image and sampling once.
class GltfTextureList {
 public:
  struct Entry {
    int image = 0;
    bool nearest = false;
    Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
    bool operator==(const Entry&) const = default;
  };

  // The index of the glTF texture in this list; -1, with a warning, where it has no image that is read here.
  int add(const GltfDocument& document, int texture, const std::string& place, std::vector<std::string>& warnings);

  const std::vector<Entry>& entries() const { return entries_; }

 private:
  std::vector<Entry> entries_;
};

// On all threads. Error, naming the image, for one that is missing or cannot be decoded. control: to be interrupted.
std::vector<Texture> decode_textures(const GltfDocument& document, const GltfTextureList& list, const Control& control);

}  // namespace chiaro::renderer

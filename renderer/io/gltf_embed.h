#pragma once
// A glTF file made to stand alone.

#include <filesystem>
#include <optional>
#include <string>

#include "renderer/io/gltf_uri.h"

namespace chiaro::renderer {

struct GltfEmbedding {
  UriBase base;          // of external files
  bool as_text = false;  // all data as data URIs; else buffer 0 and external images go to the BIN chunk
};

// The JSON with every external buffer and image embedded, and the BIN chunk that belongs to it. Buffers keep their
// indices, and all that refers to them stays as it is, extensions unknown to us among it; only where a GLB is made of a
// file whose buffer 0 has no data do they move by one. Error for missing files.
std::string embed(const std::string& json, std::optional<std::string>& binary, const GltfEmbedding& embedding);

}  // namespace chiaro::renderer

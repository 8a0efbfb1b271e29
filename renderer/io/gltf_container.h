#pragma once
// The outermost layer of a glTF file: text, or the chunks of a GLB.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace chiaro::renderer {

struct GltfContainer {
  std::string json;
  std::optional<std::string> binary;                                // the BIN chunk of a GLB
  std::vector<std::pair<std::uint32_t, std::string>> other_chunks;  // type and bytes, in the order of the file
};

// Error for a file that is neither, glTF 1.0, or truncated.
GltfContainer read_gltf_container(const std::filesystem::path& path);

// Its JSON alone, without the binary chunk being read. Empty for what is neither, and for what is no regular file.
std::string read_gltf_json(const std::filesystem::path& path);

bool is_glb(std::string_view bytes);

// Whether a file of this name is written as text.
bool writes_gltf_text(const std::filesystem::path& path);

// The bytes of a GLB. Error, naming `path`, for more than GLB's 4 GiB.
std::string make_glb(const GltfContainer& container, const std::filesystem::path& path);

}  // namespace chiaro::renderer

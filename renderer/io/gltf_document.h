#pragma once
// A glTF file in memory: its structure as tinygltf parsed it, its buffers, and where its images are.

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/core/external_files.h"
#include "renderer/io/gltf_json.h"

namespace tinygltf {
class Model;
struct Scene;
}  // namespace tinygltf

namespace chiaro::renderer {

struct GltfDocument {
  std::filesystem::path path;
  ExternalFiles external = ExternalFiles::kInFolder;
  std::shared_ptr<const tinygltf::Model> model;  // without buffers, images, animations, skins: see `json`
  GltfJson json;
  std::string binary;                            // the BIN chunk of a GLB
  std::vector<std::string> buffers;              // bytes; empty before load_buffers
  std::map<int, std::string> decoded_views;      // by buffer view: contents of those that were compressed
  std::map<int, std::string> decoded_accessors;  // by accessor: elements one after the other, where compressed
  std::vector<std::string> warnings;
};

// The structure alone. Error as check_gltf_json, and for an extension under extensionsRequired that is not read here.
GltfDocument open_gltf(const std::filesystem::path& path, ExternalFiles external = ExternalFiles::kInFolder);

// Brings in the buffers and what is compressed in them. Error for missing files, for buffers shorter than they say, and
// for compressed data that are damaged.
void load_buffers(GltfDocument& document);

// The bytes of a buffer view. Error where it reaches beyond its buffer.
std::string_view buffer_view_bytes(const GltfDocument& document, int buffer_view);

// The encoded bytes of an image.
std::string image_bytes(const GltfDocument& document, int image);

// The file's scene, or its first where it names none; null: it has none.
const tinygltf::Scene* shown_scene(const GltfDocument& document);

// Each begins with the file's name.
std::vector<std::string> naming_file(const GltfDocument& document, std::vector<std::string> warnings);

[[noreturn]] void fail(const GltfDocument& document, const std::string& place, const std::string& problem,
                       const std::string& expected);

}  // namespace chiaro::renderer

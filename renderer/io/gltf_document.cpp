#include "renderer/io/gltf_document.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "renderer/core/error.h"
#include "renderer/core/first_line.h"
#include "renderer/io/gltf_container.h"
#include "renderer/io/gltf_draco.h"
#include "renderer/io/gltf_extensions.h"
#include "renderer/io/gltf_meshopt.h"
#include "renderer/io/gltf_uri.h"

namespace chiaro::renderer {
namespace {

std::shared_ptr<const tinygltf::Model> parse(const std::string& structure, const std::filesystem::path& path) {
  tinygltf::TinyGLTF parser;
  auto model = std::make_shared<tinygltf::Model>();
  std::string error, warning;
  bool parsed = false;
  try {
    parsed =
        parser.LoadASCIIFromString(model.get(), &error, &warning, structure.data(), unsigned(structure.size()), "");
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  if (!parsed) throw Error({path.string(), "JSON", first_line(error), "a glTF 2.0 scene"});
  return model;
}

UriBase base_of(const GltfDocument& document) { return {document.path, document.external}; }

// A buffer without data is refused where it is read.
std::string load_buffer(GltfDocument& document, std::size_t index) {
  const GltfBufferSource& source = document.json.buffers[index];
  const std::string place = fmt::format("buffers[{}]", index);
  if (!source.uri && (index > 0 || document.binary.empty())) return "";
  std::string bytes =
      source.uri ? read_uri(*source.uri, base_of(document), place + ".uri") : std::move(document.binary);
  if (bytes.size() < source.byte_length) {
    fail(document, place, fmt::format("has {} bytes", bytes.size()), fmt::format("byteLength, {}", source.byte_length));
  }
  bytes.resize(source.byte_length);
  return bytes;
}

}  // namespace

std::vector<std::string> naming_file(const GltfDocument& document, std::vector<std::string> warnings) {
  for (std::string& warning : warnings) warning = document.path.string() + ": " + warning;
  return warnings;
}

void fail(const GltfDocument& document, const std::string& place, const std::string& problem,
          const std::string& expected) {
  throw Error({document.path.string(), place, problem, expected});
}

GltfDocument open_gltf(const std::filesystem::path& path, ExternalFiles external) {
  GltfContainer container = read_gltf_container(path);
  GltfDocument document;
  document.path = path;
  document.external = external;
  document.json = check_gltf_json(container.json, path);
  check_extensions(document);
  document.model = parse(document.json.structure, path);
  document.json.structure = {};
  if (container.binary) document.binary = *std::move(container.binary);
  return document;
}

void load_buffers(GltfDocument& document) {
  document.buffers.resize(document.json.buffers.size());
  for (std::size_t i = 0; i < document.buffers.size(); ++i) document.buffers[i] = load_buffer(document, i);
  document.binary = {};
  decode_meshopt_views(document);
  decode_draco_primitives(document);
}

std::string_view buffer_view_bytes(const GltfDocument& document, int buffer_view) {
  const auto decoded = document.decoded_views.find(buffer_view);
  if (decoded != document.decoded_views.end()) return decoded->second;
  const tinygltf::BufferView& view = document.model->bufferViews[buffer_view];
  const std::string& buffer = document.buffers[view.buffer];
  const std::string place = fmt::format("bufferViews[{}]", buffer_view);
  if (buffer.empty() && view.byteLength > 0) {
    fail(document, place, fmt::format("buffers[{}] has no data", view.buffer), "a uri or a BIN chunk");
  }
  if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset) {
    fail(document, place,
         fmt::format("{} bytes at {} reach beyond buffers[{}]", view.byteLength, view.byteOffset, view.buffer),
         fmt::format("at most {} bytes", buffer.size()));
  }
  return std::string_view(buffer).substr(view.byteOffset, view.byteLength);
}

std::string image_bytes(const GltfDocument& document, int image) {
  const GltfImageSource& source = document.json.images[image];
  const std::string place = fmt::format("images[{}]", image);
  if (source.uri) return read_uri(*source.uri, base_of(document), place + ".uri");
  if (source.buffer_view < 0) fail(document, place, "has neither a uri nor a bufferView", "one of them");
  return std::string(buffer_view_bytes(document, source.buffer_view));
}

const tinygltf::Scene* shown_scene(const GltfDocument& document) {
  const std::vector<tinygltf::Scene>& scenes = document.model->scenes;
  return scenes.empty() ? nullptr : &scenes[std::size_t(std::max(0, document.model->defaultScene))];
}

}  // namespace chiaro::renderer

#include "renderer/io/gltf_embed.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "renderer/core/error.h"
#include "renderer/io/gltf_uri.h"

namespace chiaro::renderer {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kLeastChunk = 4;
constexpr const char* kBufferMimeType = "application/octet-stream";

bool is_external(const ordered_json& object) {
  return object.contains("uri") && !is_data_uri(object["uri"].get_ref<const std::string&>());
}

std::string bytes_of(const ordered_json& object, const GltfEmbedding& embedding, const std::string& place) {
  return read_uri(object["uri"].get_ref<const std::string&>(), embedding.base, place + ".uri");
}

// Empty: of a kind that is not known.
std::string mime_type_of(const ordered_json& image, const std::string& bytes) {
  if (image.contains("mimeType")) return image["mimeType"].get<std::string>();
  if (bytes.starts_with("\x89PNG")) return "image/png";
  if (bytes.starts_with("\xff\xd8")) return "image/jpeg";
  if (bytes.starts_with("RIFF")) return "image/webp";
  if (bytes.substr(0, 12).find("ftypavi") == 4) return "image/avif";
  if (bytes.starts_with("\xabKTX 20\xbb")) return "image/ktx2";
  if (bytes.starts_with("DDS ")) return "image/vnd-ms.dds";
  return "";
}

// The bytes that a buffer says it has.
void trim(std::string& bytes, const ordered_json& buffer, std::size_t index, const GltfEmbedding& embedding) {
  const std::size_t length = buffer["byteLength"].get<std::size_t>();
  if (bytes.size() < length) {
    throw Error({embedding.base.gltf.string(), fmt::format("buffers[{}]", index),
                 fmt::format("has {} bytes", bytes.size()), fmt::format("byteLength, {}", length)});
  }
  bytes.resize(length);
}

void refer_to_next_buffer(ordered_json& view) {
  if (view.contains("buffer")) view["buffer"] = view["buffer"].get<std::size_t>() + 1;
}

// Buffer 0 of a GLB is its chunk. One without data, such as the plain form of what is compressed in others, moves on.
void free_first_buffer(ordered_json& root, std::optional<std::string>& binary) {
  if (binary || !root.contains("buffers") || root["buffers"].empty() || root["buffers"][0].contains("uri")) return;
  binary = std::string(kLeastChunk, '\0');
  root["buffers"].insert(root["buffers"].begin(), ordered_json{{"byteLength", kLeastChunk}});
  if (!root.contains("bufferViews")) return;
  for (ordered_json& view : root["bufferViews"]) {
    refer_to_next_buffer(view);
    if (!view.contains("extensions")) continue;
    for (auto& [name, extension] : view["extensions"].items()) {
      if (extension.is_object()) refer_to_next_buffer(extension);
    }
  }
}

// Buffer 0 becomes the BIN chunk, whether it was a file, a data URI, or that already.
void move_first_buffer(ordered_json& root, std::optional<std::string>& binary, const GltfEmbedding& embedding) {
  if (!root.contains("buffers") || root["buffers"].empty()) return;
  ordered_json& first = root["buffers"][0];
  if (first.contains("uri")) binary = bytes_of(first, embedding, "buffers[0]");
  if (binary) trim(*binary, first, 0, embedding);
  first.erase("uri");
}

void embed_buffer(ordered_json& buffer, std::size_t index, std::optional<std::string>& binary,
                  const GltfEmbedding& embedding) {
  const bool in_chunk = embedding.as_text && index == 0 && !buffer.contains("uri") && binary;
  if (!in_chunk && !is_external(buffer)) return;
  std::string bytes = in_chunk ? *std::move(binary) : bytes_of(buffer, embedding, fmt::format("buffers[{}]", index));
  trim(bytes, buffer, index, embedding);
  buffer["uri"] = make_data_uri(kBufferMimeType, bytes);
}

void embed_buffers(ordered_json& root, std::optional<std::string>& binary, const GltfEmbedding& embedding) {
  if (!root.contains("buffers")) return;
  for (std::size_t i = 0; i < root["buffers"].size(); ++i) embed_buffer(root["buffers"][i], i, binary, embedding);
}

// Bytes at the end of the BIN chunk, with a new buffer view after all others.
std::size_t append_view(ordered_json& root, std::string& binary, const std::string& bytes) {
  binary.resize((binary.size() + 3) / 4 * 4);
  const std::size_t offset = binary.size();
  binary += bytes;
  if (!root.contains("buffers") || root["buffers"].empty())
    root["buffers"] = ordered_json::array({ordered_json::object()});
  root["buffers"][0]["byteLength"] = binary.size();
  ordered_json& views = root["bufferViews"];
  views.push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
  return views.size() - 1;
}

// Images that nothing uses may be missing, or of a kind that is not read here; the scene refers to them as before.
std::optional<std::string> bytes_of_image(const ordered_json& image, const GltfEmbedding& embedding) {
  try {
    return bytes_of(image, embedding, "images");
  } catch (const Error&) {
    return std::nullopt;
  }
}

void embed_image(ordered_json& root, std::size_t index, std::optional<std::string>& binary,
                 const GltfEmbedding& embedding) {
  const std::optional<std::string> found = bytes_of_image(root["images"][index], embedding);
  if (!found) return;
  const std::string& bytes = *found;
  const std::string mime_type = mime_type_of(root["images"][index], bytes);
  if (mime_type.empty()) return;
  if (embedding.as_text) {
    root["images"][index]["uri"] = make_data_uri(mime_type, bytes);
    return;
  }
  if (!binary) binary.emplace();
  const std::size_t view = append_view(root, *binary, bytes);
  ordered_json& image = root["images"][index];  // after append_view, which may move what is in root
  image["bufferView"] = view;
  image["mimeType"] = mime_type;
  image.erase("uri");
}

void embed_images(ordered_json& root, std::optional<std::string>& binary, const GltfEmbedding& embedding) {
  if (!root.contains("images")) return;
  for (std::size_t i = 0; i < root["images"].size(); ++i) {
    if (is_external(root["images"][i])) embed_image(root, i, binary, embedding);
  }
}

}  // namespace

std::string embed(const std::string& json, std::optional<std::string>& binary, const GltfEmbedding& embedding) {
  ordered_json root = ordered_json::parse(json);
  if (!embedding.as_text) {
    free_first_buffer(root, binary);
    move_first_buffer(root, binary, embedding);
  }
  embed_buffers(root, binary, embedding);
  embed_images(root, binary, embedding);
  return root.dump();
}

}  // namespace chiaro::renderer

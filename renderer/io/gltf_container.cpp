#include "renderer/io/gltf_container.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>

#include <fmt/format.h>

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/file_extension.h"

namespace chiaro::renderer {
namespace {

constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr std::size_t kHeaderSize = 12, kChunkHeaderSize = 8;

std::uint32_t read_uint32(std::string_view bytes, std::size_t at) {
  const auto byte = [&](std::size_t i) { return std::uint32_t(static_cast<unsigned char>(bytes[at + i])); };
  return byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
}

void append_uint32(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(char(value >> shift & 0xFF));
}

std::size_t padded(std::size_t size) { return (size + 3) / 4 * 4; }

std::string_view glb_body(std::string_view bytes, const std::string& file) {
  if (bytes.size() < kHeaderSize) {
    throw Error({file, "header", fmt::format("truncated after {} bytes", bytes.size()), "12 bytes"});
  }
  const std::uint32_t version = read_uint32(bytes, 4), length = read_uint32(bytes, 8);
  if (version != 2) throw Error({file, "header", fmt::format("GLB version {}", version), "2"});
  if (length > bytes.size() || length < kHeaderSize) {
    throw Error({file, "header", fmt::format("the length says {} bytes, the file has {}", length, bytes.size()),
                 "a whole file"});
  }
  return bytes.substr(kHeaderSize, length - kHeaderSize);
}

void take_chunk(GltfContainer& container, std::uint32_t type, std::string_view bytes,
                std::optional<std::string_view>& binary) {
  if (type == kJsonChunk && container.json.empty()) {
    container.json = bytes;
  } else if (type == kBinaryChunk && !binary) {
    binary = bytes;
  } else {
    container.other_chunks.emplace_back(type, bytes);
  }
}

// What is left of `bytes` when all but `part` of them is cut away: without a copy, as it may be most of the memory.
std::string cut(std::string bytes, std::string_view part) {
  const auto first = std::size_t(part.data() - bytes.data()), size = part.size();
  bytes.resize(first + size);
  bytes.erase(0, first);
  return bytes;
}

GltfContainer read_glb(std::string bytes, const std::string& file) {
  const std::string_view body = glb_body(bytes, file);
  GltfContainer container;
  std::optional<std::string_view> binary;
  std::size_t at = 0;
  for (int chunk = 0; at + kChunkHeaderSize <= body.size(); ++chunk) {
    const std::uint32_t length = read_uint32(body, at), type = read_uint32(body, at + 4);
    at += kChunkHeaderSize;
    if (length > body.size() - at) {
      throw Error({file, fmt::format("chunk {}", chunk),
                   fmt::format("the length says {} bytes, {} are left", length, body.size() - at), "a whole file"});
    }
    if (chunk == 0 && type != kJsonChunk) throw Error({file, "chunk 0", "is not JSON", "the JSON chunk first"});
    take_chunk(container, type, body.substr(at, length), binary);
    at += padded(length);
  }
  if (container.json.empty()) throw Error({file, "chunk 0", "has no JSON", "a glTF 2.0 scene"});
  if (binary) container.binary = cut(std::move(bytes), *binary);
  return container;
}

void append_chunk(std::string& glb, std::uint32_t type, const std::string& bytes, char padding) {
  append_uint32(glb, std::uint32_t(padded(bytes.size())));
  append_uint32(glb, type);
  glb += bytes;
  glb.append(padded(bytes.size()) - bytes.size(), padding);
}

std::size_t glb_size(const GltfContainer& container) {
  std::size_t size = kHeaderSize + kChunkHeaderSize + padded(container.json.size());
  if (container.binary) size += kChunkHeaderSize + padded(container.binary->size());
  for (const auto& [type, bytes] : container.other_chunks) size += kChunkHeaderSize + padded(bytes.size());
  return size;
}

// Behind the byte order mark and white space.
std::string_view without_blanks(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(" \t\r\n\xEF\xBB\xBF"), text.size()));
}

}  // namespace

bool writes_gltf_text(const std::filesystem::path& path) { return has_extension(path, {".gltf"}); }

bool is_glb(std::string_view bytes) { return bytes.substr(0, 4) == "glTF"; }

GltfContainer read_gltf_container(const std::filesystem::path& path) {
  std::string bytes = read_file(path);
  if (is_glb(bytes)) return read_glb(std::move(bytes), path.string());
  const std::string_view text = without_blanks(bytes);
  if (text.empty()) throw Error({path.string(), "", "is empty", "a glTF 2.0 scene"});
  if (!text.starts_with('{')) throw Error({path.string(), "", "is not a glTF file", ".glb or .gltf"});
  return {std::move(bytes), {}, {}};
}

std::string read_gltf_json(const std::filesystem::path& path) {
  constexpr std::size_t kBegin = kHeaderSize + kChunkHeaderSize, kHead = 4096;
  std::error_code missing;
  if (!std::filesystem::is_regular_file(path, missing)) return "";
  const std::uintmax_t size = std::filesystem::file_size(path, missing);
  std::ifstream stream(path, std::ios::binary);
  const auto read = [&](std::size_t wanted) {
    std::string bytes(std::min<std::uintmax_t>(wanted, size), '\0');
    stream.read(bytes.data(), std::streamsize(bytes.size()));
    bytes.resize(std::size_t(stream.gcount()));
    return bytes;
  };
  const std::string head = read(kHead);
  if (!is_glb(head)) return without_blanks(head).starts_with('{') ? read_file(path) : "";
  if (head.size() < kBegin || read_uint32(head, kHeaderSize + 4) != kJsonChunk) return "";
  stream.clear();
  stream.seekg(kBegin);
  return read(read_uint32(head, kHeaderSize));
}

std::string make_glb(const GltfContainer& container, const std::filesystem::path& path) {
  const std::size_t size = glb_size(container);
  if (size > std::numeric_limits<std::uint32_t>::max()) {
    throw Error({path.string(), "", fmt::format("{} bytes do not fit into a GLB", size), "at most 4 GiB"});
  }
  std::string glb = "glTF";
  glb.reserve(size);
  append_uint32(glb, 2);
  append_uint32(glb, std::uint32_t(size));
  append_chunk(glb, kJsonChunk, container.json, ' ');
  if (container.binary) append_chunk(glb, kBinaryChunk, *container.binary, '\0');
  for (const auto& [type, bytes] : container.other_chunks) append_chunk(glb, type, bytes, '\0');
  return glb;
}

}  // namespace chiaro::renderer

#include "renderer/io/draco_header.h"

namespace chiaro::renderer {
namespace {

constexpr std::uint64_t kMesh = 1, kSequential = 0, kEdgebreaker = 1, kMetadataFlag = 0x8000;
constexpr int kMaxDepth = 64;

// Reads beyond the end give zeros, and `good` tells.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  bool good() const { return good_; }

  void skip(std::uint64_t count) {
    good_ = good_ && count <= bytes_.size();
    bytes_.remove_prefix(good_ ? std::size_t(count) : bytes_.size());
  }

  std::uint64_t fixed(int size) {
    std::uint64_t value = 0;
    for (int i = 0; i < size; ++i) value |= byte() << (8 * i);
    return value;
  }

  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const std::uint64_t next = byte();
      value |= (next & 0x7F) << shift;
      if ((next & 0x80) == 0) break;
    }
    return value;
  }

 private:
  std::uint64_t byte() {
    if (bytes_.empty()) good_ = false;
    if (!good_) return 0;
    const auto value = static_cast<unsigned char>(bytes_.front());
    bytes_.remove_prefix(1);
    return value;
  }

  std::string_view bytes_;
  bool good_ = true;
};

void skip_metadata(Reader& reader, int depth) {
  if (depth > kMaxDepth) return reader.skip(~std::uint64_t{0});
  for (std::uint64_t entries = reader.varint(); entries > 0 && reader.good(); --entries) {
    reader.skip(reader.fixed(1));
    reader.skip(reader.varint());
  }
  for (std::uint64_t children = reader.varint(); children > 0 && reader.good(); --children) {
    reader.skip(reader.fixed(1));
    skip_metadata(reader, depth + 1);
  }
}

void skip_geometry_metadata(Reader& reader) {
  for (std::uint64_t attributes = reader.varint(); attributes > 0 && reader.good(); --attributes) {
    reader.varint();
    skip_metadata(reader, 0);
  }
  skip_metadata(reader, 0);
}

}  // namespace

std::optional<DracoSizes> draco_sizes(std::string_view bytes) {
  if (bytes.substr(0, 5) != "DRACO") return std::nullopt;
  Reader reader(bytes.substr(5));
  const std::uint64_t major = reader.fixed(1), version = major << 8 | reader.fixed(1);
  const std::uint64_t geometry = reader.fixed(1), method = reader.fixed(1), flags = reader.fixed(2);
  if (geometry != kMesh || method > kEdgebreaker) return std::nullopt;
  if (version >= 0x103 && (flags & kMetadataFlag) != 0) skip_geometry_metadata(reader);
  DracoSizes sizes;
  if (method == kSequential) {
    const auto number = [&] { return version < 0x202 ? reader.fixed(4) : reader.varint(); };
    sizes.faces = number();
    sizes.points = number();
  } else {
    const auto number = [&] { return version < 0x200 ? reader.fixed(4) : reader.varint(); };
    reader.skip(1);                 // the kind of traversal
    if (version < 0x202) number();  // new vertices
    number();                       // encoded vertices
    sizes.faces = number();
  }
  return reader.good() ? std::optional(sizes) : std::nullopt;
}

}  // namespace chiaro::renderer

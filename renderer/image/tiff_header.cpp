#include "renderer/image/tiff_header.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <map>

#include <fmt/format.h>

namespace chiaro::renderer {
namespace {

// TIFF 6.0, section 8.
constexpr std::uint64_t kBitsPerSample = 258, kPhotometricInterpretation = 262, kColorMap = 320, kPalette = 3;

struct Entry {
  std::uint64_t count = 0;
  std::uint64_t value = 0;  // where there is one
};

// Section 2: of a whole number without sign; 0: another type.
int bytes_of_type(std::uint64_t type) {
  constexpr std::uint64_t kByte = 1, kShort = 3, kLong = 4, kLong8 = 16;
  return type == kByte ? 1 : type == kShort ? 2 : type == kLong ? 4 : type == kLong8 ? 8 : 0;
}

// TIFF 6.0, section 2, and BigTIFF, whose counts and offsets have eight bytes.
class DirectoryReader {
 public:
  explicit DirectoryReader(std::istream& stream) : stream_(stream) {
    little_ = stream_.get() == 'I';
    stream_.get();
    constexpr std::uint64_t kVersionOfBig = 43;
    big_ = number(2) == kVersionOfBig;
    if (big_) number(4);  // the size of offsets, and two zeros
  }

  std::map<std::uint64_t, Entry> read() {
    stream_.seekg(std::streamoff(number(offset_size())));
    std::map<std::uint64_t, Entry> entries;
    constexpr std::uint64_t kMost = 65535;  // as many as there are tags
    for (std::uint64_t left = std::min(number(big_ ? 8 : 2), kMost); left > 0 && stream_; --left) {
      const std::uint64_t tag = number(2);
      const int bytes = std::min(bytes_of_type(number(2)), offset_size());
      const std::uint64_t count = number(offset_size()), value = number(bytes);
      stream_.seekg(offset_size() - bytes, std::ios::cur);
      if (stream_) entries.try_emplace(tag, Entry{count, value});
    }
    return entries;
  }

 private:
  int offset_size() const { return big_ ? 8 : 4; }

  std::uint64_t number(int bytes) {
    std::uint64_t number = 0;
    for (int i = 0; i < bytes; ++i) {
      const std::uint64_t byte = std::uint64_t(stream_.get()) & 0xFF;
      number = little_ ? number | byte << (8 * i) : number << 8 | byte;
    }
    return number;
  }

  std::istream& stream_;
  bool little_ = true, big_ = false;
};

}  // namespace

std::optional<std::string> find_tiff_header_damage(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  const std::map<std::uint64_t, Entry> entries = DirectoryReader(stream).read();
  const auto entry = [&](std::uint64_t tag) {
    const auto found = entries.find(tag);
    return found == entries.end() ? Entry{} : found->second;
  };
  const Entry bits = entries.contains(kBitsPerSample) ? entry(kBitsPerSample) : Entry{1, 1}, palette = entry(kColorMap);
  const bool is_palette = entry(kPhotometricInterpretation).value == kPalette && bits.count == 1 && bits.value <= 16;
  if (!is_palette || palette.count == std::uint64_t{3} << bits.value) return std::nullopt;
  return fmt::format("its palette has {} numbers, not {}", palette.count, 3 << bits.value);
}

}  // namespace chiaro::renderer

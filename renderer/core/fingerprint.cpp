#include "renderer/core/fingerprint.h"

#include <cstring>

#include <fmt/format.h>

namespace chiaro::renderer {
namespace {

// Finaliser of Steele, Lea, Flood, Fast Splittable Pseudorandom Number Generators, 2014 (splitmix64).
std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

}  // namespace

void Fingerprint::add_bytes(const void* data, std::size_t size) {
  const char* bytes = static_cast<const char*>(data);
  for (; size >= 8; size -= 8, bytes += 8) {
    std::uint64_t word;
    std::memcpy(&word, bytes, 8);
    state_ = mix(state_ ^ word) + 0x9e3779b97f4a7c15ULL;
  }
  if (size > 0) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes, size);
    state_ = mix(state_ ^ word) + size;
  }
}

std::string Fingerprint::text() const { return fmt::format("{:016x}", mix(state_)); }

}  // namespace chiaro::renderer

#pragma once
// Fingerprints of data, to tell whether a cache belongs to a scene. Not cryptographic.

#include <cstdint>
#include <span>
#include <string>

namespace chiaro::renderer {

class Fingerprint {
 public:
  void add_bytes(const void* data, std::size_t size);
  template <class T>
  void add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    add_bytes(&value, sizeof value);
  }
  template <class T>
  void add_all(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add(values.size());
    add_bytes(values.data(), values.size_bytes());
  }
  void add(const std::string& text) { add_all(std::span<const char>(text)); }

  // Sixteen hexadecimal digits.
  std::string text() const;

 private:
  std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

}  // namespace chiaro::renderer

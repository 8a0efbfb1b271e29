#pragma once
// What the JSON of a glTF file may hold, as far as it is read here, as a table.

#include <cstdint>
#include <span>
#include <string_view>

namespace chiaro::renderer {

enum class JsonKind : std::uint8_t {
  kObject,
  kArray,
  kString,
  kBoolean,
  kNumber,   // within `low` and `high`
  kNumbers,  // an array of `size` of them
  kCount,    // a whole number ≥ 0
  kIndex,    // of an element of the array `target`
  kIndices,  // an array of them
};

// The largest float, as it is mostly written.
inline constexpr double kLargestNumber = 3.4028235e38;

struct JsonRule {
  std::string_view path;  // from the root: "key", "[]" every element, "*" every member; separated by dots
  JsonKind kind;
  bool required = false;  // by the object that holds it
  std::string_view target = {};
  int size = 0;
  double low = -kLargestNumber, high = kLargestNumber;
};

// An object's or array's own rule stands before those of what it holds.
std::span<const JsonRule> gltf_json_rules();

}  // namespace chiaro::renderer

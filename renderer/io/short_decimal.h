#pragma once

#include <charconv>

namespace chiaro::renderer {

// The double with the fewest decimal digits that is `value` again as a float, so that files say 0.3 and not
// 0.30000001192092896.
inline double short_decimal(float value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  double decimal = 0;
  std::from_chars(digits, end, decimal);
  return decimal;
}

}  // namespace chiaro::renderer

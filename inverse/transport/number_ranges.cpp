#include "inverse/transport/number_ranges.h"

#include <fmt/format.h>

#include <charconv>

namespace chiaro::inverse {
namespace {

constexpr int kLargest = 100'000'000;

std::optional<int> take_number(const char*& at, const char* end) {
  int value = 0;
  const auto [next, code] = std::from_chars(at, end, value);
  if (code != std::errc() || value < 0 || value > kLargest) return std::nullopt;
  at = next;
  return value;
}

}  // namespace

std::string format_number_ranges(const std::vector<int>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    if (!text.empty()) text += ',';
    text += last > i ? fmt::format("{}-{}", numbers[i], numbers[last]) : fmt::format("{}", numbers[i]);
    i = last + 1;
  }
  return text;
}

std::optional<std::vector<int>> parse_number_ranges(const std::string& text, std::size_t most) {
  std::vector<int> numbers;
  const char* at = text.data();
  const char* end = at + text.size();
  while (at != end) {
    const auto first = take_number(at, end);
    if (!first || (!numbers.empty() && *first <= numbers.back())) return std::nullopt;
    auto last = first;
    if (at != end && *at == '-') last = take_number(++at, end);
    if (!last || *last < *first || std::size_t(*last - *first) >= most - numbers.size()) return std::nullopt;
    for (int n = *first; n <= *last; ++n) numbers.push_back(n);
    if (at != end && (*at++ != ',' || at == end)) return std::nullopt;
  }
  return numbers;
}

}  // namespace chiaro::inverse

#include "cli/option_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/usage_error.h"

namespace chiaro::cli {
namespace {

[[noreturn]] void refuse(std::string_view text, const std::string& expected) {
  throw UsageError(fmt::format("'{}' (expected {})", text, expected));
}

template <class T>
bool parses_whole(std::string_view text, T& value) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);  // which from_chars knows not
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end;
}

std::string describe(const NumberRange& range) {
  const bool has_min = range.min > std::numeric_limits<double>::lowest();
  const bool has_max = range.max < std::numeric_limits<double>::max();
  if (has_min && has_max && range.min_excluded) {
    return fmt::format("a number above {} and at most {}", range.min, range.max);
  }
  if (has_min && has_max) return fmt::format("a number from {} to {}", range.min, range.max);
  if (has_min) return fmt::format("a number {} {}", range.min_excluded ? "above" : "not below", range.min);
  if (has_max) return fmt::format("a number not above {}", range.max);
  return "a finite number";
}

std::string describe(const CountRange& range) {
  if (range.max == std::numeric_limits<int>::max()) return fmt::format("a whole number not below {}", range.min);
  return fmt::format("a whole number from {} to {}", range.min, range.max);
}

bool contains(const NumberRange& range, double value) {
  if (!std::isfinite(value)) return false;
  return (range.min_excluded ? range.min < value : range.min <= value) && value <= range.max;
}

// A bound as it is given is in range, although the nearest float may lie beyond it.
NumberRange as_floats(NumberRange range) {
  for (double* bound : {&range.min, &range.max}) {
    if (std::abs(*bound) <= double(std::numeric_limits<float>::max())) *bound = double(float(*bound));
  }
  return range;
}

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace

double parse_number(std::string_view text, const NumberRange& range) {
  double value = 0;
  if (!parses_whole(text, value) || !contains(range, value)) refuse(text, describe(range));
  return value;
}

template <>
double parse_as<double>(std::string_view text, const NumberRange& range) {
  return parse_number(text, range);
}

template <>
float parse_as<float>(std::string_view text, const NumberRange& range) {
  const double value = parse_number(text, range);
  const bool fits = std::abs(value) <= double(std::numeric_limits<float>::max());
  if (!fits) refuse(text, fmt::format("a number of at most {:.1e}", std::numeric_limits<float>::max()));
  if (!contains(as_floats(range), double(float(value)))) refuse(text, describe(range));
  return float(value);
}

int parse_count(std::string_view text, const CountRange& range) {
  int value = 0;
  if (!parses_whole(text, value) || value < range.min || value > range.max) refuse(text, describe(range));
  return value;
}

double parse_bytes(std::string_view text) {
  constexpr std::string_view kUnits = "kMGT";
  const std::string_view all = text;
  double scale = 1;
  if (!text.empty()) {
    if (const std::size_t unit = kUnits.find(text.back()); unit != std::string_view::npos) {
      scale = std::pow(1000.0, double(unit + 1));
      text.remove_suffix(1);
    }
  }
  double value = 0;
  if (!parses_whole(text, value) || !contains(kPositive, value))
    refuse(all, "bytes above 0, or with k, M, G or T: 800M, 4G");
  return scale * value;
}

std::uint64_t parse_seed(std::string_view text) {
  std::uint64_t value = 0;
  if (!parses_whole(text, value)) refuse(text, "a whole number from 0 to 18446744073709551615");
  return value;
}

std::vector<double> parse_numbers(std::string_view text, std::size_t count, const NumberRange& range) {
  const std::vector<std::string_view> parts = split(text);
  if (parts.size() != count) refuse(text, fmt::format("{} numbers with commas between", count));
  std::vector<double> numbers;
  for (const std::string_view part : parts) numbers.push_back(parse_number(part, range));
  return numbers;
}

GridSize parse_grid(std::string_view text) {
  GridSize size;
  if (text.ends_with('%')) {
    size.error = parse_number(text.substr(0, text.size() - 1), kPercent) / 100;
    return size;
  }
  const std::vector<std::string_view> parts = split(text);
  if (parts.size() != 3) refuse(text, "X,Y,Z: three whole numbers with commas between, or a percentage: 5%");
  std::int64_t nodes = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    size.counts[axis] = parse_count(parts[axis], {1, int(kMaxGridNodes)});
    nodes = std::min(nodes * size.counts[axis], kMaxGridNodes + 1);
  }
  if (nodes > kMaxGridNodes) refuse(text, fmt::format("at most {} nodes", kMaxGridNodes));
  return size;
}

std::string parse_region_text(const std::string& text) {
  if (text.empty()) refuse(text, "the name of a node, or x0,y0,z0,x1,y1,z1");
  const std::vector<std::string_view> parts = split(text);
  double ignored = 0;
  const bool all_numbers =
      std::all_of(parts.begin(), parts.end(), [&](auto part) { return parses_whole(part, ignored); });
  if (parts.size() > 1 && all_numbers) parse_numbers(text, 6, {});
  return text;
}

renderer::Vec3f parse_albedo(std::string_view text) {
  const std::size_t count = split(text).size();
  if (count != 1 && count != 3) refuse(text, "R or R,G,B, each from 0 to 1");
  const std::vector<double> rgb = parse_numbers(text, count, kZeroToOne);
  return {float(rgb.front()), float(rgb[count / 2]), float(rgb.back())};
}

std::vector<std::string> parse_words(std::string_view text, const std::vector<std::string>& allowed) {
  std::vector<std::string> words;
  for (const std::string_view part : split(text)) {
    if (part == "all") {
      words = allowed;
      continue;
    }
    if (std::find(allowed.begin(), allowed.end(), part) == allowed.end()) {
      refuse(part, fmt::format("all, or some of {} with commas between", fmt::join(allowed, ", ")));
    }
    if (std::find(words.begin(), words.end(), part) == words.end()) words.emplace_back(part);
  }
  return words;
}

}  // namespace chiaro::cli

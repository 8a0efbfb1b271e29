#pragma once
// Values of options, from their text. All throw UsageError where the text is malformed, not finite or out of range.

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/core/vec.h"

namespace chiaro::cli {

struct NumberRange {
  double min = std::numeric_limits<double>::lowest();
  double max = std::numeric_limits<double>::max();
  bool min_excluded = false;  // min < value instead of min <= value
};

inline constexpr NumberRange kPositive{.min = 0, .min_excluded = true};
inline constexpr NumberRange kNotNegative{.min = 0};
inline constexpr NumberRange kPositiveFloat{.min = 0, .max = 1e30, .min_excluded = true};  // floats have room for it
inline constexpr NumberRange kPercent{.min = 0, .max = 100, .min_excluded = true};
inline constexpr NumberRange kZeroToOne{.min = 0, .max = 1};

struct CountRange {
  int min = 1;
  int max = std::numeric_limits<int>::max();
};

double parse_number(std::string_view text, const NumberRange& range);

// The same as float or double; in range also after rounding.
template <class T>
T parse_as(std::string_view text, const NumberRange& range);
template <>
double parse_as<double>(std::string_view text, const NumberRange& range);
template <>
float parse_as<float>(std::string_view text, const NumberRange& range);

int parse_count(std::string_view text, const CountRange& range);
// "800M", "1.5G": bytes, in powers of 1000.
double parse_bytes(std::string_view text);
std::uint64_t parse_seed(std::string_view text);

// Exactly `count` numbers with commas between.
std::vector<double> parse_numbers(std::string_view text, std::size_t count, const NumberRange& range);

// "X,Y,Z", each at least 1, and at most kMaxGridNodes nodes together; or "E%", the error of interpolation.
struct GridSize {
  std::array<int, 3> counts{};
  double error = 0;  // 0: not given
};
inline constexpr std::int64_t kMaxGridNodes = 1'000'000;
GridSize parse_grid(std::string_view text);

// The name of a node, or six numbers; given back as it is. Numbers that are not six, or not finite, are a fault.
std::string parse_region_text(const std::string& text);

// "R,G,B" or one number for all three, each 0 to 1.
renderer::Vec3f parse_albedo(std::string_view text);

// Words with commas between, each one of `allowed`; "all" means all of them.
std::vector<std::string> parse_words(std::string_view text, const std::vector<std::string>& allowed);

}  // namespace chiaro::cli

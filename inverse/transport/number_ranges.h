#pragma once

#include <optional>
#include <string>
#include <vector>

namespace chiaro::inverse {

// Ascending whole numbers ≥ 0 as text: {0, 1, 2, 7} is "0-2,7".
std::string format_number_ranges(const std::vector<int>& numbers);

// The way back; absent where the text is malformed or not ascending.
std::optional<std::vector<int>> parse_number_ranges(const std::string& text);

}  // namespace chiaro::inverse

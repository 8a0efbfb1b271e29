#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace chiaro::inverse {

// Ascending whole numbers ≥ 0 as text: {0, 1, 2, 7} is "0-2,7".
std::string format_number_ranges(const std::vector<int>& numbers);

// The way back; absent where the text is malformed, not ascending, or of more than `most` numbers.
std::optional<std::vector<int>> parse_number_ranges(const std::string& text, std::size_t most);

}  // namespace chiaro::inverse

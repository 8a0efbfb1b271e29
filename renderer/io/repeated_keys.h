#pragma once
// Objects with two members of one name: a parser would silently take the last.

#include <string>

namespace chiaro::renderer {

// Error, if an object of this text is one. Text that is no JSON passes: its parser tells more of that.
void refuse_repeated_keys(const std::string& text, const std::string& file);

}  // namespace chiaro::renderer

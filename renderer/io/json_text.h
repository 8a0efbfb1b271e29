#pragma once
// What a parser passes over: of two members of one name it takes the last, and nothing behind a NUL.

#include <string>

namespace chiaro::renderer {

// Error, if an object of this text has two members of one name, or the text goes on behind a NUL. Text that is no JSON
// passes: its parser tells more of that.
void check_json_text(const std::string& text, const std::string& file);

}  // namespace chiaro::renderer

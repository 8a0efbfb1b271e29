#pragma once
// The report's page and the libraries that it uses, embedded when the program is built (CMakeLists.txt lists them).

#include <string_view>

namespace chiaro::inverse {

// Its bytes; empty where no such file is embedded.
std::string_view embedded_file(std::string_view name);

}  // namespace chiaro::inverse

#pragma once
// The page of a run, embedded when the program is built (CMakeLists.txt lists its files).

#include <string_view>

namespace chiaro::cli {

// Its bytes; empty where no such file is embedded.
std::string_view embedded_file(std::string_view name);

}  // namespace chiaro::cli

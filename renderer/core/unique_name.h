#pragma once
// Names that nothing else has, on other machines that share the folder neither.

#include <string>

namespace chiaro::renderer {

// 16 hexadecimal digits by chance.
std::string unique_name();

}  // namespace chiaro::renderer

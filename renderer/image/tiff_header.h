#pragma once
// What libtiff passes without a word in the directory of a TIFF.

#include <filesystem>
#include <optional>
#include <string>

namespace chiaro::renderer {

// What is wrong with the directory of a TIFF's first picture: a palette of another length than its samples ask for, which
// libtiff would drop, and take indices for grey. Nothing where it cannot be read: libtiff tells more of that.
std::optional<std::string> find_tiff_header_damage(const std::filesystem::path& path);

}  // namespace chiaro::renderer

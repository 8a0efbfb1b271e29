#pragma once
// The header of an OpenEXR file, looked at before a library takes memory by what it says.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace chiaro::renderer {

// What is wrong with it: attributes that are longer than the file or another length than their type, tiles or lines beyond
// all measure or more than the file has room for, what decides of these twice, primaries of another type. Absent where
// nothing is, and for other files.
// Source: Industrial Light & Magic, OpenEXR File Layout, section "Header".
std::optional<std::string> find_exr_header_damage(const std::filesystem::path& path);

// Where the header ends in a file of one part, and the table begins that says where its chunks are. Absent where that
// cannot be told.
std::optional<std::uint64_t> end_of_exr_header(const std::filesystem::path& path);

}  // namespace chiaro::renderer

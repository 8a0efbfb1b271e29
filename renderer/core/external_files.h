#pragma once
// Which files a file may have opened.

#include <cstdint>
#include <filesystem>

namespace chiaro::renderer {

enum class ExternalFiles : std::uint8_t {
  kInFolder,  // of the file that names them, or below: a file from elsewhere does not open what it likes
  kAnywhere,
};

// Whether `file`, links followed, is in `folder` or below. False for what is not there.
bool is_in_folder(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace chiaro::renderer

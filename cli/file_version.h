#pragma once

#include <cstdint>
#include <filesystem>

namespace chiaro::cli {

// Which state of a file was read, as far as the file system tells.
struct FileVersion {
  std::uintmax_t size = 0;
  std::filesystem::file_time_type written{};

  bool operator==(const FileVersion&) const = default;
};

// That of a file which is not there is that of an empty one.
inline FileVersion version_of(const std::filesystem::path& file) {
  std::error_code no_size, no_time;
  const FileVersion version{std::filesystem::file_size(file, no_size), std::filesystem::last_write_time(file, no_time)};
  return no_size || no_time ? FileVersion{} : version;
}

}  // namespace chiaro::cli

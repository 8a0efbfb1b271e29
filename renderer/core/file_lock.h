#pragma once
// One process at a time works on a file.

#include <filesystem>
#include <optional>

namespace chiaro::renderer {

// Whether `path` names the file that is open as `descriptor`.
bool names_open_file(const std::filesystem::path& path, int descriptor);

// Holds `path`, which is made where it is missing, until it goes; under whatever name the file is by then. Error where
// another process holds it. Where the file system has no locks it holds nothing.
class FileLock {
 public:
  explicit FileLock(const std::filesystem::path& path);
  // A new file alone; nothing where there is one of that name.
  static std::optional<FileLock> make_new(const std::filesystem::path& path);
  static FileLock of_folder(const std::filesystem::path& folder);
  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&& other) noexcept;

 private:
  FileLock(const std::filesystem::path& path, int file);
  int file_;
};

}  // namespace chiaro::renderer

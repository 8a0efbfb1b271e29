#include "renderer/core/file_lock.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include "renderer/core/error.h"

namespace chiaro::renderer {
namespace {

// Some network file systems: there the user sees to it that one process writes a file.
bool has_no_locks(int error) { return error == ENOSYS || error == ENOLCK || error == EOPNOTSUPP; }

}  // namespace

bool names_open_file(const std::filesystem::path& path, int descriptor) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && stat(path.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

FileLock::FileLock(const std::filesystem::path& path)
    : FileLock(path, ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {}

std::optional<FileLock> FileLock::make_new(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0 && errno == EEXIST) return std::nullopt;
  return FileLock(path, file);
}

FileLock FileLock::of_folder(const std::filesystem::path& folder) {
  return FileLock(folder, ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
}

// file: as it was opened, or not.
FileLock::FileLock(const std::filesystem::path& path, int file) : file_(file) {
  if (file_ < 0) throw Error({path.string(), "", fmt::format("cannot be written: {}", std::strerror(errno)), ""});
  // It may have been renamed between being opened and being locked.
  const bool locked = ::flock(file_, LOCK_EX | LOCK_NB) == 0 || has_no_locks(errno);
  if (locked && names_open_file(path, file_)) return;
  const int why = locked ? EWOULDBLOCK : errno;
  ::close(file_);
  if (why != EWOULDBLOCK) throw Error({path.string(), "", fmt::format("cannot be locked: {}", std::strerror(why)), ""});
  throw Error({path.string(), "", "another process is writing it", "its end, or another output"});
}

FileLock::~FileLock() {
  if (file_ >= 0) ::close(file_);
}

FileLock::FileLock(FileLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

FileLock& FileLock::operator=(FileLock&& other) noexcept {
  std::swap(file_, other.file_);
  return *this;
}

}  // namespace chiaro::renderer

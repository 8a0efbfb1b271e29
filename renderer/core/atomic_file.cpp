#include "renderer/core/atomic_file.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <fstream>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include "renderer/core/error.h"
#include "renderer/core/unique_name.h"

namespace chiaro::renderer {

struct UnfinishedFile::Name {
  std::atomic<bool> taken = false, whole = false;
  std::array<char, PATH_MAX> path{};
};

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int code) {
  throw Error({path.string(), "", fmt::format("cannot be written: {}", std::strerror(code)), ""});
}

// The file that the call opens or does something to, however many signals come meanwhile.
template <class Call>
int despite_signals(const Call& call) {
  int result = 0;
  do {
    result = call();
  } while (result < 0 && errno == EINTR);
  return result;
}

// 0, or why it may not be on the disk.
int sync(const std::filesystem::path& path) {
  const int file = despite_signals([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC); });
  if (file < 0) return errno;
  const int code = despite_signals([&] { return ::fsync(file); }) == 0 ? 0 : errno;
  ::close(file);
  return code == EINVAL ? 0 : code;
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

// Hidden, of the same kind, and no longer than names may be.
std::filesystem::path name_aside(const std::filesystem::path& path) {
  const std::string end = fmt::format(".{}.part{}", unique_name(), path.extension().string());
  const std::string stem = path.stem().string();
  return folder_of(path) / ('.' + stem.substr(0, NAME_MAX - 1 - std::min<std::size_t>(end.size(), NAME_MAX - 1)) + end);
}

// As open as the file that it will replace.
void keep_permissions(const std::filesystem::path& path, const std::filesystem::path& aside) {
  struct stat there {};
  if (::lstat(path.c_str(), &there) == 0 && S_ISREG(there.st_mode)) ::chmod(aside.c_str(), there.st_mode & 0777);
}

// Where a signal handler finds the names of the files being written.
std::array<UnfinishedFile::Name, 8> unfinished_names;

UnfinishedFile::Name* take_name(const std::filesystem::path& path) {
  if (path.native().size() >= PATH_MAX) return nullptr;
  for (UnfinishedFile::Name& name : unfinished_names) {
    if (name.taken.exchange(true)) continue;
    std::memcpy(name.path.data(), path.c_str(), path.native().size() + 1);
    name.whole = true;
    return &name;
  }
  return nullptr;
}

// What cannot take its place stays whole where it is. The folder's sync may fail: by then the file is in its place.
void put_into_place(const std::filesystem::path& aside, const std::filesystem::path& path) {
  keep_permissions(path, aside);
  std::error_code renamed;
  std::filesystem::rename(aside, path, renamed);
  if (renamed) {
    throw Error({path.string(), "",
                 fmt::format("cannot be written: {}; the whole file is left as {}", renamed.message(), aside.string()),
                 ""});
  }
  sync(folder_of(path));
}

// Closes the file that it is given.
class OpenFile {
 public:
  explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

[[noreturn]] void cannot_read(const std::filesystem::path& path, int code) {
  if (code == EINTR) throw Interruption();
  if (code == ENOENT) throw Error({path.string(), "", "no such file", "an existing file"});
  throw Error({path.string(), "", fmt::format("cannot be read: {}", std::strerror(code)), ""});
}

[[noreturn]] void too_large(const std::filesystem::path& path, std::uintmax_t most) {
  throw Error({path.string(), "", "is too large to be read as a whole", fmt::format("at most {} bytes", most)});
}

}  // namespace

void remove_unfinished_files() {
  for (const UnfinishedFile::Name& name : unfinished_names) {
    if (name.whole) ::unlink(name.path.data());
  }
}

UnfinishedFile::UnfinishedFile(const std::filesystem::path& path) : name_(take_name(path)) {}

UnfinishedFile::~UnfinishedFile() {
  if (name_ == nullptr) return;
  name_->whole = false;
  name_->taken = false;
}

void move_into_place(const std::filesystem::path& aside, const std::filesystem::path& path) {
  if (const int code = sync(aside)) fail(path, code);
  put_into_place(aside, path);
}

void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path&)>& write) {
  const std::filesystem::path folder = folder_of(path);
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw Error({path.string(), "", "cannot be written: no such folder", "a folder that exists"});
  }
  if (std::filesystem::is_directory(path, ignored)) {
    throw Error({path.string(), "", "is a folder", "the name of a file"});
  }
  if (path.filename().native().size() > NAME_MAX) fail(path, ENAMETOOLONG);
  const std::filesystem::path aside = name_aside(path);
  const UnfinishedFile unfinished(aside);
  try {
    write(aside);
    if (const int code = sync(aside)) fail(path, code);
  } catch (const Error& error) {
    std::filesystem::remove(aside, ignored);
    if (error.parts().file != aside.string()) throw;
    throw Error({path.string(), error.parts().place, error.parts().problem, error.parts().expected});
  } catch (...) {
    std::filesystem::remove(aside, ignored);
    throw;
  }
  put_into_place(aside, path);
}

void write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
  write_atomically(path, [&](const std::filesystem::path& aside) {
    std::ofstream stream(aside, std::ios::binary);
    stream.write(bytes.data(), std::streamsize(bytes.size()));
    stream.close();
    if (!stream) fail(path, errno);
  });
}

void require_rereadable(const std::filesystem::path& path, const std::string& expected) {
  std::error_code unknown;
  if (!std::filesystem::exists(path, unknown) || std::filesystem::is_regular_file(path, unknown)) return;
  if (std::filesystem::is_directory(path, unknown)) throw Error({path.string(), "", "is a folder", "a file"});
  throw Error({path.string(), "", "is no file that can be read twice", expected});
}

std::string read_file(const std::filesystem::path& path, std::uintmax_t most) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) cannot_read(path, errno);
  if (S_ISDIR(status.st_mode)) throw Error({path.string(), "", "is a folder", "a file"});
  if (S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode)) throw Error({path.string(), "", "is a device", "a file"});
  const OpenFile file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.descriptor() < 0) cannot_read(path, errno);
  constexpr std::size_t kPart = 1 << 16;  // of what does not tell its size, as pipes
  const bool sized = S_ISREG(status.st_mode) && status.st_size > 0;
  if (sized && std::uintmax_t(status.st_size) > most) too_large(path, most);
  std::string bytes(sized ? std::size_t(status.st_size) : kPart, '\0');
  std::size_t size = 0;
  while (size < bytes.size() || !sized) {
    if (size == bytes.size() && size >= most) too_large(path, most);
    if (size == bytes.size()) bytes.resize(2 * size);
    const ssize_t count = ::read(file.descriptor(), bytes.data() + size, bytes.size() - size);
    if (count < 0) cannot_read(path, errno);
    if (count == 0) break;
    size += std::size_t(count);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace chiaro::renderer

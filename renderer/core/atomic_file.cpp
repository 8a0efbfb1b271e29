#include "renderer/core/atomic_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>

#include "renderer/core/error.h"

namespace chiaro::renderer {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int code) {
  throw Error({path.string(), "", fmt::format("cannot be written: {}", std::strerror(code)), ""});
}

void sync(const std::filesystem::path& path, const std::filesystem::path& named) {
  const int file = ::open(path.c_str(), O_RDONLY);
  if (file < 0) fail(named, errno);
  const int result = ::fsync(file);
  const int code = errno;
  ::close(file);
  if (result != 0 && code != EINVAL) fail(named, code);
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

}  // namespace

void move_into_place(const std::filesystem::path& aside, const std::filesystem::path& path) {
  sync(aside, path);
  std::error_code renamed;
  std::filesystem::rename(aside, path, renamed);
  if (renamed) fail(path, renamed.value());
  sync(folder_of(path), path);
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
  const std::filesystem::path aside =
      folder / fmt::format(".{}.{}.part{}", path.stem().string(), ::getpid(), path.extension().string());
  try {
    write(aside);
    move_into_place(aside, path);
  } catch (...) {
    std::filesystem::remove(aside, ignored);
    throw;
  }
}

void write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
  write_atomically(path, [&](const std::filesystem::path& aside) {
    std::ofstream stream(aside, std::ios::binary);
    stream.write(bytes.data(), std::streamsize(bytes.size()));
    stream.close();
    if (!stream) fail(path, errno);
  });
}

std::string read_file(const std::filesystem::path& path) {
  std::error_code failed;
  const std::filesystem::file_status status = std::filesystem::status(path, failed);
  if (!std::filesystem::exists(status)) {
    const bool missing = status.type() == std::filesystem::file_type::not_found;
    throw Error({path.string(), "", missing ? "no such file" : "cannot be read: " + failed.message(), ""});
  }
  if (std::filesystem::is_directory(status)) throw Error({path.string(), "", "is a folder", "a file"});
  if (std::filesystem::is_character_file(status) || std::filesystem::is_block_file(status)) {
    throw Error({path.string(), "", "is a device", "a file"});
  }
  std::ifstream stream(path, std::ios::binary);
  std::error_code no_size;  // as pipes have none
  const std::uintmax_t size = std::filesystem::file_size(path, no_size);
  std::string bytes(no_size ? 0 : std::size_t(size), '\0');
  stream.read(bytes.data(), std::streamsize(bytes.size()));
  bytes.resize(std::size_t(stream.gcount()));
  if (stream.good()) bytes.append(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  if (stream.bad() || !stream.is_open()) throw Error({path.string(), "", "cannot be read", ""});
  return bytes;
}

}  // namespace chiaro::renderer

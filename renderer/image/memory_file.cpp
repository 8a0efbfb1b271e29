#include "renderer/image/memory_file.h"

#include <cerrno>

#include <sys/mman.h>
#include <unistd.h>

#include <fmt/format.h>

#include "renderer/core/error.h"

namespace chiaro::renderer {

MemoryFile::MemoryFile(std::string_view bytes) : descriptor_(::memfd_create("chiaro", MFD_CLOEXEC)) {
  while (descriptor_ >= 0 && !bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) break;
    bytes.remove_prefix(std::size_t(written));
  }
  if (bytes.empty() && descriptor_ >= 0) return;
  if (descriptor_ >= 0) ::close(descriptor_);
  throw Error({"", "", "there is no memory for a file in memory", ""});
}

MemoryFile::~MemoryFile() { ::close(descriptor_); }

std::string MemoryFile::path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

}  // namespace chiaro::renderer

#pragma once

#include <string>
#include <string_view>

namespace chiaro::renderer {

// Bytes in memory under the path of a file, for readers that want one. Gone with the object; nothing is on any disk.
class MemoryFile {
 public:
  // Error where the system has no room for it.
  explicit MemoryFile(std::string_view bytes);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const;

 private:
  int descriptor_;
};

}  // namespace chiaro::renderer

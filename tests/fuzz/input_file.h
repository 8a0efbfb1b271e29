#pragma once
// What the fuzz targets share: the bytes of an input as a file, and what a reader may do with any file.

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "renderer/core/error.h"

namespace chiaro::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// A folder of this process, in memory where the machine has such a place.
inline const std::filesystem::path& folder() {
  static const std::filesystem::path made = [] {
    const std::filesystem::path memory = "/dev/shm";
    std::error_code ignored;
    const std::filesystem::path base =
        std::filesystem::is_directory(memory, ignored) ? memory : std::filesystem::temp_directory_path();
    const std::filesystem::path path = base / ("chiaro_fuzz_" + std::to_string(::getpid()));
    std::filesystem::create_directories(path);
    return path;
  }();
  return made;
}

inline std::filesystem::path input_file(const std::string& name, std::string_view bytes) {
  std::filesystem::path path = folder() / name;
  std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
  return path;
}

// Readers take a file or refuse it with an Error that names it; whatever else they do is a fault that the fuzzer keeps.
// Returns whether the file was taken.
template <class Read>
bool read_or_refuse(const std::filesystem::path& path, Read read) {
  try {
    read();
    return true;
  } catch (const renderer::Error& error) {
    CHIARO_CHECK(std::string_view(error.what()).find(path.filename().string()) != std::string_view::npos);
    return false;
  }
}

}  // namespace chiaro::fuzz

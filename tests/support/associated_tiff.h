#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "renderer/core/atomic_file.h"

namespace chiaro::test {

// Makes a TIFF of save_image(), whose alpha is unassociated, say that its colours are multiplied by it.
inline void set_associated_alpha(const std::filesystem::path& path) {
  std::string bytes = renderer::read_file(path);
  const std::string extra_samples("\x52\x01\x03\0\x01\0\0\0", 8);  // tag 338, one 16-bit number
  const std::size_t at = bytes.find(extra_samples);
  ASSERT_NE(at, std::string::npos);
  ASSERT_EQ(bytes[at + 8], 2) << "unassociated";
  bytes[at + 8] = 1;
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace chiaro::test

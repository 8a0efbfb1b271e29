#pragma once

#include <string>
#include <utility>

#include "renderer/core/error.h"

namespace chiaro::cli {

// What run() returns; an Error of it that names no file names this one.
template <class Run>
auto naming_file(const std::string& file, Run&& run) {
  try {
    return std::forward<Run>(run)();
  } catch (const renderer::Error& error) {
    renderer::Error::Parts parts = error.parts();
    if (parts.file.empty()) parts.file = file;
    throw renderer::Error(std::move(parts));
  }
}

}  // namespace chiaro::cli

#pragma once
// What image libraries throw, as the Error that ours do. For the .cpp files that call them.

#include <exception>
#include <filesystem>
#include <new>
#include <string>

#include "renderer/core/error.h"

namespace chiaro::renderer {

// Libraries wait for what pipes bring, and read on and on from devices.
inline void require_file(const std::filesystem::path& path, const char* expected) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) return;
  if (!std::filesystem::exists(path, ignored)) throw Error({path.string(), "", "no such file", "an existing file"});
  throw Error({path.string(), "", "is not a file", expected});
}

// What `read` returns; Error, naming `file`, whatever it throws.
template <class Read>
auto read_through_library(const std::string& file, Read read) {
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error({file, "", "takes more memory than there is", "an image of a sensible size"});
  } catch (const std::exception& error) {
    throw Error({file, "", std::string("cannot be decoded: ") + error.what(), "a whole image"});
  }
}

}  // namespace chiaro::renderer

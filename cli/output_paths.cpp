#include "cli/output_paths.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <unordered_map>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/usage_error.h"
#include "renderer/core/error.h"
#include "renderer/core/file_extension.h"
#include "renderer/core/file_lock.h"
#include "renderer/core/shortened.h"
#include "renderer/core/unique_name.h"
#include "renderer/io/referred_files.h"

namespace chiaro::cli {
namespace {

using renderer::Error;

constexpr std::size_t kLongestName = 100;  // bytes of a name of a user's, of which a file's may have 255

// Permissions alone do not tell: a folder may be on a read-only or a virtual file system.
void try_to_make_file(const std::filesystem::path& folder, const std::filesystem::path& wanted) {
  const auto fail = [&] {
    throw Error({wanted.string(), "", fmt::format("cannot be written: {}", std::strerror(errno)), ""});
  };
  struct stat there {};
  if (::stat(wanted.c_str(), &there) != 0 && errno == ENAMETOOLONG) fail();
  const std::filesystem::path probe = folder / fmt::format(".chiaro.{}.probe", renderer::unique_name());
  const int file = ::open(probe.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600);
  if (file < 0) fail();
  ::close(file);
  ::unlink(probe.c_str());
}

// Of the shell: `> LIGHTS.json` beside `-o LIGHTS.glb` would lose one of the two.
bool is_standard_output(const std::filesystem::path& path) {
  struct stat output {};
  return fstat(STDOUT_FILENO, &output) == 0 && S_ISREG(output.st_mode) &&
         renderer::names_open_file(path, STDOUT_FILENO);
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

// Links in the place of the file itself are not followed: an output takes the link's place, not that of what it leads
// to.
bool are_same(const std::filesystem::path& a, const std::filesystem::path& b) {
  if (a.empty() || b.empty() || a.filename() != b.filename()) return false;
  std::error_code unknown;
  return std::filesystem::equivalent(folder_of(a), folder_of(b), unknown);
}

// What is read through a link is lost with it, with any that it leads to, and with the file where they end.
bool leads_to(std::filesystem::path input, const std::filesystem::path& output) {
  constexpr int kMostLinks = 40;  // that Linux follows
  std::error_code unknown;
  for (int i = 0; i < kMostLinks && !are_same(input, output); ++i) {
    if (!std::filesystem::is_symlink(input, unknown)) return false;
    input = folder_of(input) / std::filesystem::read_symlink(input, unknown);
  }
  return are_same(input, output);
}

// The output that would take the input's place.
const std::filesystem::path* in_place_of(const std::filesystem::path& input,
                                         const std::vector<std::filesystem::path>& outputs) {
  const auto found = std::find_if(outputs.begin(), outputs.end(), [&](const auto& o) { return leads_to(input, o); });
  return found == outputs.end() ? nullptr : &*found;
}

[[noreturn]] void refuse(const std::filesystem::path& output, const std::string& problem) {
  throw Error({output.string(), "", problem, "another name for the output"});
}

// Files are looked into only where an output is there already, and could be one of those that they refer to.
void require_apart_from_referred(const std::vector<std::filesystem::path>& inputs,
                                 const std::vector<std::filesystem::path>& outputs) {
  std::error_code unknown;
  const auto is_there = [&](const std::filesystem::path& output) {
    return std::filesystem::exists(std::filesystem::symlink_status(output, unknown));
  };
  if (std::none_of(outputs.begin(), outputs.end(), is_there)) return;
  for (const std::filesystem::path& input : inputs) {
    for (const std::filesystem::path& referred : renderer::referred_files(input)) {
      if (const auto* output = in_place_of(referred, outputs)) {
        refuse(*output, fmt::format("is an input of this command: {} refers to it", input.string()));
      }
    }
  }
}

}  // namespace

void require_extension(const std::filesystem::path& path, const std::vector<std::string>& extensions) {
  if (renderer::has_extension(path, extensions)) return;
  throw UsageError(fmt::format("'{}' (expected a name ending in {})", path.string(), fmt::join(extensions, " or ")));
}

void require_file_name(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Error({path.string(), "", "is a folder", "the name of a file"});
  }
  if (is_standard_output(path)) {
    throw Error({path.string(), "", "is where standard output goes", "another file for the summary"});
  }
}

void require_replaceable(const std::filesystem::path& wanted) {
  struct statx there {};
  constexpr unsigned kWanted = STATX_TYPE | STATX_MODE | STATX_UID;
  if (::statx(AT_FDCWD, wanted.c_str(), AT_SYMLINK_NOFOLLOW, kWanted, &there) != 0) return;
  const auto refuse = [&](const char* problem) {
    throw Error({wanted.string(), "", fmt::format("cannot be replaced: {}", problem), "another name for the output"});
  };
  if (!S_ISREG(there.stx_mode) && !S_ISLNK(there.stx_mode)) refuse("it is a pipe, a socket or a device");
  if (there.stx_attributes & (STATX_ATTR_IMMUTABLE | STATX_ATTR_APPEND)) refuse("its attributes forbid it");
  if (there.stx_attributes & STATX_ATTR_MOUNT_ROOT) refuse("something is mounted on it");
  struct stat around {};
  const uid_t user = ::geteuid();
  const bool sticky = ::stat(folder_of(wanted).c_str(), &around) == 0 && (around.st_mode & S_ISVTX) != 0;
  if (sticky && user != 0 && user != there.stx_uid && user != around.st_uid) {
    refuse("it is another user's, in a folder where each replaces only what is their own");
  }
}

void require_writable(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::path folder = folder_of(path);
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw Error({path.string(), "", "cannot be written: no such folder", "a folder that exists"});
  }
  require_file_name(path);
  try_to_make_file(folder, path);
  require_replaceable(path);
}

void require_apart(const std::vector<std::filesystem::path>& inputs,
                   const std::vector<std::filesystem::path>& outputs) {
  for (const std::filesystem::path& input : inputs) {
    if (const auto* output = in_place_of(input, outputs)) refuse(*output, "is an input of this command");
  }
  std::unordered_multimap<std::string, const std::filesystem::path*> by_name;
  for (const std::filesystem::path& output : outputs) {
    const auto [first, last] = by_name.equal_range(output.filename().string());
    if (std::any_of(first, last, [&](const auto& other) { return are_same(*other.second, output); })) {
      throw Error({output.string(), "", "is another output of this command", "a name of its own for each"});
    }
    by_name.emplace(output.filename().string(), &output);
  }
  require_apart_from_referred(inputs, outputs);
}

void require_not_a_file(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder, ignored) || std::filesystem::is_directory(folder, ignored)) return;
  throw Error({folder.string(), "", "is a file", "the name of a folder"});
}

NewFolders::~NewFolders() {
  std::error_code ignored;
  for (auto made = made_.rbegin(); made != made_.rend(); ++made) {
    if (std::filesystem::is_empty(*made, ignored)) std::filesystem::remove(*made, ignored);
  }
}

void NewFolders::make(const std::filesystem::path& folder) {
  require_not_a_file(folder);
  std::error_code failed;
  std::vector<std::filesystem::path> missing;
  for (auto at = folder; !at.empty() && !std::filesystem::exists(at, failed); at = at.parent_path()) {
    missing.push_back(at);
  }
  made_.insert(made_.end(), missing.rbegin(), missing.rend());
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Error({folder.string(), "", fmt::format("cannot be made: {}", failed.message()), "a folder"});
  require_writable(folder / "contents");
}

std::filesystem::path beside(const std::filesystem::path& path, const std::string& extension) {
  return std::filesystem::path(path).replace_extension(extension);
}

std::string file_name_of(const std::string& name) {
  std::string result = name.empty() ? "unnamed" : name;
  for (char& c : result) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '.' || (c & 0x80);
    if (!plain) c = '_';
  }
  if (result.front() == '.') result.front() = '_';
  return renderer::shortened(result, kLongestName);
}

}  // namespace chiaro::cli

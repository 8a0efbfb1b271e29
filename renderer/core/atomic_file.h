#pragma once
// Outputs appear whole or not at all.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace chiaro::renderer {

// Calls write(path) with a name beside `path` that nothing has (same folder, same extension), syncs what it wrote and
// renames it to `path`, with the permissions of what it replaces. If write throws, or the write fails, nothing is left
// behind and what was at `path` before stays. An Error of write that names the other file names `path` instead. Missing
// parent folders are an Error. If what is whole cannot take its place, it is left, and the Error says where.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path&)>& write);

// Syncs a file that was written aside, in the folder of `path`, and renames it to `path`.
void move_into_place(const std::filesystem::path& aside, const std::filesystem::path& path);

// As write_atomically, for bytes in memory.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

// A file that remove_unfinished_files() removes while this lives. Where too many are being written it does not.
class UnfinishedFile {
 public:
  struct Name;
  explicit UnfinishedFile(const std::filesystem::path& path);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

 private:
  Name* name_;
};

// Removes what is being written aside. For signal handlers that end the program.
void remove_unfinished_files();

// Error where it is there and gives its bytes only once, as a pipe.
void require_rereadable(const std::filesystem::path& path, const std::string& expected);

// The bytes of a file; Error where it is missing, a folder, unreadable or longer than `most`; Interruption where a signal
// came while a pipe was waited for.
std::string read_file(const std::filesystem::path& path, std::uintmax_t most = std::uintmax_t{1} << 32);

}  // namespace chiaro::renderer

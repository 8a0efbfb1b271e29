#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace chiaro::cli {

// UsageError where `path` ends in none of `extensions` (".exr"; case does not matter).
void require_extension(const std::filesystem::path& path, const std::vector<std::string>& extensions);

// Error where a folder has the name, or standard output is that file.
void require_file_name(const std::filesystem::path& path);

// Error where what is there is not one's own to replace, or cannot be replaced at all.
void require_replaceable(const std::filesystem::path& path);

// Error where a file could not be made at `path`, or standard output is that file: asked before the long work starts.
void require_writable(const std::filesystem::path& path);

// Error where an output would take the place of an input, of a file that an input refers to, or of another output,
// whatever their names. Inputs are what links lead to, and the links. Empty paths count for nothing.
void require_apart(const std::vector<std::filesystem::path>& inputs, const std::vector<std::filesystem::path>& outputs);

// Error where `folder` exists and is something else than a folder.
void require_not_a_file(const std::filesystem::path& folder);

// Folders made for the outputs of a command. Those that are empty when it ends go again: it wrote nothing.
class NewFolders {
 public:
  NewFolders() = default;
  NewFolders(const NewFolders&) = delete;
  NewFolders& operator=(const NewFolders&) = delete;
  ~NewFolders();
  // And those that it is in, where they are missing; Error where it cannot be made, is a file, or takes no files.
  void make(const std::filesystem::path& folder);

 private:
  std::vector<std::filesystem::path> made_;  // outer ones first
};

// `path` with another extension, beside it.
std::filesystem::path beside(const std::filesystem::path& path, const std::string& extension);

// A file name for something a user has named: characters that file systems or shells mind become '_'.
std::string file_name_of(const std::string& name);

}  // namespace chiaro::cli

#pragma once
// The chunks of an OpenEXR file: OpenEXR's own reader takes one that holds too little for a whole one, and whatever its
// buffer held before for the rest.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace chiaro::renderer {

class ExrChunks {
 public:
  explicit ExrChunks(const std::filesystem::path& path);
  ~ExrChunks();

  // A tile of the first part: its lines, each channel after channel in the order of their names, least significant
  // bytes first. Nothing where it is missing or damaged.
  std::vector<char> read_tile(int x, int y) const;

  // What is wrong with the lines, or the tiles of the finest level, of a part. Nothing is where the file cannot be
  // opened: readers tell more of that.
  std::optional<std::string> find_damage(int part) const;

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

}  // namespace chiaro::renderer

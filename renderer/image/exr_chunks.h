#pragma once
// The chunks of an OpenEXR file: OpenEXR's own reader takes one that holds too little for a whole one, and whatever its
// buffer held before for the rest.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace chiaro::renderer {

struct ExrTilePlace {
  int x = 0, y = 0;
  std::uint64_t begin = 0;  // of what it holds, in the file
  std::uint32_t bytes = 0;
};

class ExrChunks {
 public:
  explicit ExrChunks(const std::filesystem::path& path);
  ~ExrChunks();

  // A tile of the first part: its lines, each channel after channel in the order of their names, least significant
  // bytes first. Nothing where it is missing or damaged.
  std::vector<char> read_tile(int x, int y) const;

  int count() const;  // that the first part has when it is whole; 0 where that cannot be told

  // Of a file of one part: whether it goes on at least to the end of the table that says where its chunks are. True where
  // that cannot be told.
  bool has_table() const;

  // Of a file of one part that was not finished, and does not say where its tiles are: those that stand behind the table,
  // up to where there is none, or one that has been there before. Not the last of them where it is not compressed: of what
  // a computer without power had not written yet it may have zeros.
  std::vector<ExrTilePlace> find_tiles() const;

  // As above, from its place.
  std::vector<char> read_tile(const ExrTilePlace& place) const;

  // What is wrong with the lines, or the tiles of the finest level, of a part. Nothing is where the file cannot be
  // opened: readers tell more of that.
  std::optional<std::string> find_damage(int part) const;

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

}  // namespace chiaro::renderer

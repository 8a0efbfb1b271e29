#pragma once
// Bakes into files: interrupted ones that go on, and parts that are joined.

#include <filesystem>
#include <span>

#include "inverse/transport/bake.h"

namespace chiaro::inverse {

// Part `index` of `count`, from 0: about as many receivers each.
struct Shard {
  std::size_t index = 0, count = 1;
};

struct BakeFileOptions {
  Shard shard = {};
  bool resume = false;
  bool keeps_unfinished = true;  // where it fails; when it is interrupted it always does
};

// Where a bake is until it is whole: beside the file.
std::filesystem::path unfinished_bake(const std::filesystem::path& file);
// All names that baking into a file may take.
std::vector<std::filesystem::path> files_of_bake(const std::filesystem::path& file);

// Writes the receivers of a shard, all lights, as they are baked, and puts the file in its place when it is whole. What
// there is of an unfinished bake stays when it is interrupted or fails, and is gone on with if `resume`: the same bytes
// come out. Error where that is of another bake or being written by another process, or the disk is full.
BakeSummary bake_to_file(Baker& baker, const std::filesystem::path& file, const BakeFileOptions& options,
                         const renderer::Control& control);

// Joins shards, in any order and with tiles of any size, to the bytes of a bake in one go. Error where they are not of
// one bake, or one is missing or cut short.
void merge_transport_caches(std::span<const std::filesystem::path> shards, const std::filesystem::path& output,
                            const renderer::Control& control);

}  // namespace chiaro::inverse

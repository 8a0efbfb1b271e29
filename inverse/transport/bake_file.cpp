#include "inverse/transport/bake_file.h"

#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/file_lock.h"
#include "renderer/core/seconds_since.h"

namespace chiaro::inverse {
namespace {

namespace fs = std::filesystem;
using renderer::Error;

constexpr std::size_t kBand = TransportCacheWriter::kLights;
constexpr std::size_t kColumns = 8 * TransportCacheWriter::kMostReceivers;  // copied at once

struct Range {
  std::size_t first, last;
};

Range receivers_of(Shard shard, const TransportCache& header) {
  const std::size_t tile = TransportCacheWriter::receivers_of_tile(header.grid.positions.size());
  const auto begin = [&](std::size_t index) {
    return index == shard.count ? header.receiver_count : index * header.receiver_count / shard.count / tile * tile;
  };
  const Range range{begin(shard.index), begin(shard.index + 1)};
  if (range.first < range.last) return range;
  throw Error({"", "option --shard",
               fmt::format("{} receivers do not make {} parts", header.receiver_count, shard.count), "fewer parts"});
}

// Copies tiles of some lights and receivers; returns the first receiver that could not be read, or range.last.
std::size_t copy_tiles(TransportCacheReader& from, std::size_t first_light, Range range, std::size_t columns,
                       TransportCacheWriter& to, const renderer::Control& control) {
  for (std::size_t receiver = range.first; receiver < range.last; receiver += columns) {
    if (control.stop_requested()) throw renderer::Interruption();
    TransportBlock block;
    block.first_light = first_light;
    block.light_count = std::min(kBand, from.header().grid.positions.size() - first_light);
    block.first_receiver = receiver, block.receiver_count = std::min(columns, range.last - receiver);
    if (!from.read(block)) return receiver;
    to.write(block);
  }
  return range.last;
}

// What an unfinished bake has. Returns where it ends.
Baker::Place take_over(TransportCacheReader& old, Range range, TransportCacheWriter& writer,
                       const renderer::Control& control) {
  const std::size_t lights = old.header().grid.positions.size();
  for (std::size_t light = 0; light < lights; light += kBand) {
    const std::size_t end = copy_tiles(old, light, range, kColumns, writer, control);
    if (end == range.last) continue;
    return {light, copy_tiles(old, light, {end, range.last}, old.receivers_of_tile(), writer, control)};
  }
  return {lights, range.first};
}

// nullptr: it ends within its header, and has nothing.
std::unique_ptr<TransportCacheReader> open_unfinished(const fs::path& file) {
  try {
    return std::make_unique<TransportCacheReader>(file);
  } catch (const Error&) {
    return nullptr;
  }
}

// A bake that is being written, by this process alone.
struct Unfinished {
  renderer::FileLock lock;
  std::unique_ptr<TransportCacheWriter> writer;
};

// Another file than what had the name: nothing is written through a link or a pipe, nor into a file with a second name.
renderer::FileLock replace_file(const fs::path& file) {
  std::error_code ignored;
  if (!fs::is_directory(fs::symlink_status(file, ignored))) fs::remove(file, ignored);
  return renderer::FileLock(file);
}

// Unless another process is writing it.
renderer::FileLock replace_idle_file(const fs::path& file) {
  std::error_code ignored;
  std::optional<renderer::FileLock> there;
  if (fs::is_regular_file(fs::symlink_status(file, ignored))) there.emplace(file);
  return replace_file(file);
}

std::unique_ptr<TransportCacheWriter> begin_anew(const fs::path& unfinished, const TransportCache& header,
                                                 Range range) {
  return std::make_unique<TransportCacheWriter>(unfinished, header, range.first, range.last);
}

void go_on(const fs::path& unfinished, const TransportCache& header, Range range, Baker::Place& start,
           const renderer::Control& control, Unfinished& bake) {
  const auto unfinished_cache = open_unfinished(unfinished);
  if (!unfinished_cache) {
    bake.lock = replace_file(unfinished);
    bake.writer = begin_anew(unfinished, header, range);
    return;
  }
  TransportCacheReader& old = *unfinished_cache;
  if (!old.is_of(header) || old.first_receiver() != range.first || old.last_receiver() != range.last) {
    throw Error({unfinished.string(), "header", "of another scene or of a bake with other options",
                 "the same again, or no --resume"});
  }
  const fs::path aside = unfinished.string() + ".new";
  try {
    Unfinished next{replace_idle_file(aside), begin_anew(aside, header, range)};
    start = take_over(old, range, *next.writer, control);
    std::error_code renamed;
    fs::rename(aside, unfinished, renamed);
    if (renamed) throw Error({unfinished.string(), "", "cannot be written: " + renamed.message(), ""});
    bake = std::move(next);
  } catch (...) {
    std::error_code ignored;
    fs::remove(aside, ignored);
    throw;
  }
}

std::vector<std::unique_ptr<TransportCacheReader>> open_shards(std::span<const fs::path> files) {
  std::vector<std::unique_ptr<TransportCacheReader>> shards;
  for (const fs::path& file : files) {
    shards.push_back(std::make_unique<TransportCacheReader>(file));
    if (!shards.back()->of_one_bake(*shards.front())) {
      throw Error({file.string(), "header", "not of the same bake as " + files.front().string(),
                   "parts made from one scene with the same options"});
    }
  }
  std::sort(shards.begin(), shards.end(),
            [](const auto& a, const auto& b) { return a->first_receiver() < b->first_receiver(); });
  return shards;
}

// Every receiver once.
void require_all(const std::vector<std::unique_ptr<TransportCacheReader>>& shards) {
  std::size_t next = 0;
  for (const auto& shard : shards) {
    if (shard->first_receiver() < next) {
      throw Error({shard->path().string(), "",
                   fmt::format("has receiver {}, as another part does", shard->first_receiver()), "every part once"});
    }
    if (shard->first_receiver() > next) break;
    next = shard->last_receiver();
  }
  const std::size_t count = shards.front()->header().receiver_count;
  if (next == count) return;
  throw Error(
      {shards.front()->path().string(), "", fmt::format("no part has receiver {} of {}", next, count), "all parts"});
}

}  // namespace

fs::path unfinished_bake(const fs::path& file) { return file.string() + ".unfinished"; }

BakeSummary bake_to_file(Baker& baker, const fs::path& file, const BakeFileOptions& options,
                         const renderer::Control& control) {
  const TransportCache& header = baker.header();
  const Range range = receivers_of(options.shard, header);
  const fs::path unfinished = unfinished_bake(file);
  Baker::Place start{0, range.first};
  const bool goes_on = options.resume && fs::exists(unfinished);
  if (goes_on && !fs::is_regular_file(unfinished)) {
    throw Error({unfinished.string(), "", "is not a file", "an unfinished bake, or no --resume"});
  }
  Unfinished bake{goes_on ? renderer::FileLock(unfinished) : replace_idle_file(unfinished), nullptr};
  if (goes_on) {
    go_on(unfinished, header, range, start, control, bake);
  } else {
    bake.writer = begin_anew(unfinished, header, range);
  }
  double write_seconds = 0;
  const auto write = [&](const TransportBlock& block) {
    const auto begin = std::chrono::steady_clock::now();
    bake.writer->write(block);
    write_seconds += renderer::seconds_since(begin);
  };
  baker.bake(range.first, range.last, start, write, control);
  const auto begin = std::chrono::steady_clock::now();
  bake.writer->close();
  renderer::move_into_place(unfinished, file);
  BakeSummary summary = baker.summary();
  summary.write_seconds = write_seconds + renderer::seconds_since(begin);
  return summary;
}

void merge_transport_caches(std::span<const fs::path> files, const fs::path& output, const renderer::Control& control) {
  const auto shards = open_shards(files);
  require_all(shards);
  const TransportCache& header = shards.front()->header();
  const std::size_t lights = header.grid.positions.size();
  renderer::write_atomically(output, [&](const fs::path& aside) {
    TransportCacheWriter writer(aside, header, 0, header.receiver_count);
    for (std::size_t light = 0; light < lights; light += kBand) {
      for (const auto& shard : shards) {
        const Range range{shard->first_receiver(), shard->last_receiver()};
        const std::size_t end = copy_tiles(*shard, light, range, kColumns, writer, control);
        if (end < range.last) {
          throw Error(
              {shard->path().string(), fmt::format("receiver {}", end), "cut short or damaged", "a whole file"});
        }
      }
      if (control.report) control.report("merge", double(std::min(light + kBand, lights)) / double(lights));
    }
    writer.close();
  });
}

}  // namespace chiaro::inverse

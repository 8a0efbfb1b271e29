#include "inverse/transport/bake_file.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/file_lock.h"
#include "renderer/core/seconds_since.h"
#include "renderer/image/exr_chunks.h"
#include "renderer/image/exr_header.h"

namespace chiaro::inverse {
namespace {

namespace fs = std::filesystem;
using renderer::Error;

constexpr const char* kNew = ".new";  // behind the name of an unfinished bake: what it goes on in
constexpr std::size_t kBand = TransportCacheWriter::kLights;
constexpr std::size_t kColumns = 8 * TransportCacheWriter::kMostReceivers;  // copied at once, or more …
constexpr std::size_t kMostEntries = std::size_t{1} << 22;                  // … of larger tiles, up to so many

using Parts = std::span<const std::unique_ptr<TransportCacheReader>>;

struct Range {
  std::size_t first, last;
};

Range receivers_of(Shard shard, const TransportCache& header) {
  const std::size_t tile = TransportCacheWriter::receivers_of_tile(header.grid.positions.size());
  const std::size_t tiles = (header.receiver_count + tile - 1) / tile;
  if (shard.count > tiles) {
    throw Error({"", "option --shard",
                 fmt::format("{} receivers do not make {} parts", header.receiver_count, shard.count),
                 fmt::format("at most {}", tiles)});
  }
  const auto begin = [&](std::size_t index) {
    return std::min(index * tiles / shard.count * tile, header.receiver_count);
  };
  return {begin(shard.index), begin(shard.index + 1)};
}

// How much is copied at once, in whole tiles of the writer.
struct Step {
  std::size_t lights, receivers;
};

// So that tiles of any size are decoded once or twice, where memory allows: several bands only with all receivers, as
// the writer wants them.
Step step_for(Parts parts, Range range) {
  const std::size_t lights = parts.front()->header().grid.positions.size(), all = range.last - range.first;
  std::size_t tile_lights = 1, tile_receivers = 1;
  for (const auto& part : parts) {
    tile_lights = std::max(tile_lights, std::min(part->lights_of_tile(), lights));
    tile_receivers = std::max(tile_receivers, part->receivers_of_tile());
  }
  const std::size_t bands = std::min((tile_lights + kBand - 1) / kBand, kMostEntries / kBand / all);
  if (bands > 1) return {bands * kBand, all};
  constexpr std::size_t kTile = TransportCacheWriter::kMostReceivers;
  const std::size_t most = kMostEntries / std::min(lights, kBand);
  return {kBand, std::clamp(tile_receivers, kColumns, most) / kTile * kTile};
}

void put_into(TransportBlock& block, const TransportBlock& piece) {
  for (std::size_t light = 0; light < piece.light_count; ++light) {
    const auto from = std::ptrdiff_t(light * piece.receiver_count);
    const auto to = std::ptrdiff_t(light * block.receiver_count + piece.first_receiver - block.first_receiver);
    std::copy_n(piece.visibility.begin() + from, piece.receiver_count, block.visibility.begin() + to);
    std::copy_n(piece.indirect.begin() + from, piece.receiver_count, block.indirect.begin() + to);
  }
}

// What is no light transport is no number.
bool is_transport(const TransportBlock& block) {
  return std::all_of(block.indirect.begin(), block.indirect.end(), [](Vec3f v) { return is_finite(v); });
}

// Fills the block from the parts that have its receivers; returns the first that lacks some of them, or holds
// what is none, or nullptr.
const TransportCacheReader* read(Parts parts, TransportBlock& block) {
  block.resize();
  for (const auto& part : parts) {
    TransportBlock piece;
    piece.first_light = block.first_light, piece.light_count = block.light_count;
    piece.first_receiver = std::max(block.first_receiver, part->first_receiver());
    const std::size_t last = std::min(block.first_receiver + block.receiver_count, part->last_receiver());
    if (piece.first_receiver >= last) continue;
    piece.receiver_count = last - piece.first_receiver;
    if (!part->read(piece) || !is_transport(piece)) return part.get();
    put_into(block, piece);
  }
  return nullptr;
}

// From parts that together have the range.
struct Copy {
  Parts from;
  Range range;
  TransportCacheWriter& to;
  const renderer::Control& control;
};

struct Damage {
  Baker::Place place;
  const TransportCacheReader* part;  // nullptr: none
};

// Copies from `start` to the end, or to what cannot be read.
Damage copy_entries(const Copy& copy, Baker::Place start, Step step) {
  const std::size_t lights = copy.from.front()->header().grid.positions.size();
  Baker::Place at = start;
  for (; at.light < lights; at = {at.light + step.lights, copy.range.first}) {
    for (; at.receiver < copy.range.last; at.receiver += step.receivers) {
      copy.control.stop_if_requested();
      TransportBlock block;
      block.first_light = at.light, block.light_count = std::min(step.lights, lights - at.light);
      block.first_receiver = at.receiver;
      block.receiver_count = std::min(step.receivers, copy.range.last - at.receiver);
      if (const TransportCacheReader* damaged = read(copy.from, block)) return {at, damaged};
      copy.to.write(block);
    }
    const double done = double(std::min(at.light + step.lights, lights)) / double(lights);
    if (copy.control.report) copy.control.report("merge", done);
  }
  return {at, nullptr};
}

// What an unfinished bake has, to the last tile of the writer. Returns where it ends.
Baker::Place take_over(Parts old, Range range, TransportCacheWriter& writer, const renderer::Control& control) {
  const renderer::Control quiet = control.without_progress();
  const std::size_t lights = old.front()->header().grid.positions.size();
  const std::size_t tile = TransportCacheWriter::receivers_of_tile(lights);
  Step step = step_for(old, range);
  Damage end = copy_entries({old, range, writer, quiet}, {0, range.first}, step);
  while (end.part != nullptr && (step.lights > kBand || step.receivers > tile)) {
    step = {kBand, std::max(tile, step.receivers / 2 / tile * tile)};
    end = copy_entries({old, range, writer, quiet}, end.place, step);
  }
  return end.place;
}

// As a computer without power leaves what it had not written yet.
bool begins_with_zeros(const fs::path& file) {
  std::array<char, 8> magic_and_version{};
  std::ifstream(file, std::ios::binary).read(magic_and_version.data(), magic_and_version.size());
  return magic_and_version == std::array<char, 8>{};
}

// nullptr: there is none, or it ends before its first tile, and has nothing. Error where it is another kind of file, or
// of another version.
std::unique_ptr<TransportCacheReader> open_unfinished(const fs::path& file) {
  constexpr std::uintmax_t kMagicAndVersion = 8;  // bytes
  std::error_code ignored;
  const bool begun = fs::is_regular_file(file, ignored) && fs::file_size(file, ignored) >= kMagicAndVersion;
  if (!begun || begins_with_zeros(file) || renderer::find_exr_header_damage(file)) return nullptr;
  if (!renderer::ExrChunks(file).has_table()) return nullptr;
  return std::make_unique<TransportCacheReader>(file);
}

// A bake that is being written, by this process alone.
struct Unfinished {
  renderer::FileLock lock;
  std::unique_ptr<TransportCacheWriter> writer;
};

// Another file than what has the name, which this process holds or which is none: nothing is written through a link or
// a pipe, nor into a file with a second name. Nothing where another process has made one meanwhile.
std::optional<renderer::FileLock> replace_file(const fs::path& file) {
  std::error_code ignored;
  if (!fs::is_directory(fs::symlink_status(file, ignored))) fs::remove(file, ignored);
  return renderer::FileLock::make_new(file);
}

// Unless another process is writing it.
renderer::FileLock replace_idle_file(const fs::path& file) {
  for (int tries = 0; tries < 2; ++tries) {
    std::error_code ignored;
    std::optional<renderer::FileLock> there;
    const fs::file_type type = fs::symlink_status(file, ignored).type();
    if (type == fs::file_type::regular) there.emplace(file);
    auto made = type == fs::file_type::not_found ? renderer::FileLock::make_new(file) : replace_file(file);
    if (made) return std::move(*made);
  }
  return renderer::FileLock(file);
}

std::unique_ptr<TransportCacheWriter> begin_anew(const fs::path& unfinished, const TransportCache& header,
                                                 Range range) {
  return std::make_unique<TransportCacheWriter>(unfinished, header, range.first, range.last);
}

void go_on(const fs::path& unfinished, const TransportCache& header, Range range, Baker::Place& start,
           const renderer::Control& control, Unfinished& bake) {
  const auto unfinished_cache = open_unfinished(unfinished);
  if (!unfinished_cache) {
    auto made = replace_file(unfinished);
    bake.lock = made ? std::move(*made) : renderer::FileLock(unfinished);
    bake.writer = begin_anew(unfinished, header, range);
    return;
  }
  const TransportCacheReader& old = *unfinished_cache;
  if (!old.is_of(header) || old.first_receiver() != range.first || old.last_receiver() != range.last) {
    throw Error({unfinished.string(), "header", "of another scene or of a bake with other options",
                 "the same again, or no --resume"});
  }
  const fs::path aside = unfinished.string() + kNew;
  const renderer::UnfinishedFile removed_on_signal(aside);
  try {
    Unfinished next{replace_idle_file(aside), begin_anew(aside, header, range)};
    start = take_over(Parts(&unfinished_cache, 1), range, *next.writer, control);
    next.writer->flush();
    renderer::move_into_place(aside, unfinished);
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

BakeSummary bake_and_write(Baker& baker, Range range, Baker::Place start, TransportCacheWriter& writer,
                           const renderer::Control& control) {
  double seconds = 0;
  const auto timed = [&](const auto& act) {
    const auto begin = std::chrono::steady_clock::now();
    act();
    seconds += renderer::seconds_since(begin);
  };
  const auto write = [&](const TransportBlock& block) { timed([&] { writer.write(block); }); };
  baker.bake(range.first, range.last, start, write, control);
  timed([&] { writer.close(); });
  BakeSummary summary = baker.summary();
  summary.write_seconds = seconds;
  return summary;
}

}  // namespace

fs::path unfinished_bake(const fs::path& file) { return file.string() + ".unfinished"; }

std::vector<fs::path> files_of_bake(const fs::path& file) {
  const fs::path unfinished = unfinished_bake(file);
  return {file, unfinished, unfinished.string() + kNew};
}

BakeSummary bake_to_file(Baker& baker, const fs::path& file, const BakeFileOptions& options,
                         const renderer::Control& control) {
  const TransportCache& header = baker.header();
  const Range range = receivers_of(options.shard, header);
  const fs::path unfinished = unfinished_bake(file);
  Baker::Place start{0, range.first};
  std::error_code unknown;  // of a link that leads to itself
  const bool goes_on = options.resume && (fs::exists(unfinished, unknown) || unknown);
  if (goes_on && !fs::is_regular_file(unfinished, unknown)) {
    throw Error({unfinished.string(), "", "is not a file", "an unfinished bake, or no --resume"});
  }
  Unfinished bake{goes_on ? renderer::FileLock(unfinished) : replace_idle_file(unfinished), nullptr};
  BakeSummary summary;
  try {
    if (goes_on) {
      go_on(unfinished, header, range, start, control, bake);
    } else {
      std::error_code ignored;
      fs::remove(unfinished.string() + kNew, ignored);  // of one that was killed as it went on
      bake.writer = begin_anew(unfinished, header, range);
    }
    summary = bake_and_write(baker, range, start, *bake.writer, control);
  } catch (const renderer::Interruption&) {
    throw;
  } catch (...) {
    std::error_code ignored;
    if (!options.keeps_unfinished) fs::remove(unfinished, ignored);
    throw;
  }
  const auto begin = std::chrono::steady_clock::now();
  renderer::move_into_place(unfinished, file);
  summary.write_seconds += renderer::seconds_since(begin);
  return summary;
}

void merge_transport_caches(std::span<const fs::path> files, const fs::path& output, const renderer::Control& control) {
  const auto shards = open_shards(files);
  require_all(shards);
  const TransportCache& header = shards.front()->header();
  const Range all{0, header.receiver_count};
  renderer::write_atomically(output, [&](const fs::path& aside) {
    TransportCacheWriter writer(aside, header, all.first, all.last);
    const Damage damage = copy_entries({shards, all, writer, control}, {0, all.first}, step_for(shards, all));
    if (damage.part != nullptr) {
      throw Error({damage.part->path().string(),
                   fmt::format("receiver {}", std::max(damage.place.receiver, damage.part->first_receiver())),
                   "cut short or damaged", "a whole file"});
    }
    writer.close();
  });
}

}  // namespace chiaro::inverse

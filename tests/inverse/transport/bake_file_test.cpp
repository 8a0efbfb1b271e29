#include "inverse/transport/bake_file.h"

#include <cstring>
#include <limits>

#include <sys/stat.h>

#include <gtest/gtest.h>

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/image/exr_chunks.h"
#include "renderer/image/exr_header.h"
#include "tests/support/code_scenes.h"
#include "tests/support/retile.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::inverse {
namespace {

namespace fs = std::filesystem;
using renderer::Error;
using renderer::read_file;

constexpr double kAllMemory = std::numeric_limits<double>::infinity();

class BakeFile : public ::testing::Test {
 protected:
  // Baked once for all tests, each of which has it in its folder.
  BakeFile() {
    static const std::string baked = read_file(bake_as({}, "whole.exr"));
    folder_.write("whole.exr", baked);
  }

  fs::path bake_as(const BakeFileOptions& options, const std::string& name, double memory = kAllMemory,
                   const renderer::Control& control = {}) const {
    Baker baker(tracer_, receivers_, grid_, settings_, memory);
    bake_to_file(baker, folder_ / name, options, control);
    return folder_ / name;
  }
  // All lights, some receivers, as another program may have it.
  fs::path columns(const fs::path& cache, const std::string& name, const test::Tiling& tiling) const {
    test::retile(cache, folder_ / name, tiling);
    return folder_ / name;
  }
  std::string whole() const { return read_file(folder_ / "whole.exr"); }

  const renderer::Scene scene_ = test::corner_with_ball();
  const renderer::RayTracer tracer_{scene_};
  const Receivers receivers_ = make_receivers(scene_, {.max_edge = 0.8F});
  // More lights than a row of tiles has.
  const LightGrid grid_ = make_light_grid(tracer_, {.counts = {12, 11, 10}, .region = {}});
  BakeSettings settings_{.samples = 2, .bounces = 2, .seed = 5, .materials = "gltf"};
  test::TemporaryFolder folder_;
};

TEST_F(BakeFile, IsWhatABakeInMemoryGives) {
  ASSERT_GT(grid_.positions.size(), TransportCacheWriter::kLights);
  const TransportCache read = load_transport_cache(folder_ / "whole.exr");
  const TransportCache expected = bake(tracer_, receivers_, grid_, settings_).cache;
  EXPECT_EQ(read.visibility, expected.visibility);
  ASSERT_EQ(read.indirect.size(), expected.indirect.size());
  for (std::size_t i = 0; i < read.indirect.size(); ++i) {
    ASSERT_NEAR(read.indirect[i].y, expected.indirect[i].y, 6e-4F * expected.indirect[i].y + 1e-6F) << i;
  }
  EXPECT_FALSE(fs::exists(unfinished_bake(folder_ / "whole.exr")));
}

TEST_F(BakeFile, IsTheSameInAsLittleMemoryAsItTakes) {
  EXPECT_EQ(read_file(bake_as({}, "small.exr", 26e6)), whole());
  EXPECT_THROW(bake_as({}, "smaller.exr", 1e6), Error);
  EXPECT_FALSE(fs::exists(folder_ / "smaller.exr"));
}

TEST_F(BakeFile, GoesOnFromWhereverItWasCut) {
  const std::string bytes = whole();
  for (const double part : {0.0, 0.005, 0.03, 0.2, 0.5, 0.77, 0.999}) {
    const fs::path file = folder_ / "resumed.exr";
    std::ofstream(unfinished_bake(file), std::ios::binary) << bytes.substr(0, std::size_t(part * double(bytes.size())));
    bake_as({.shard = {}, .resume = true}, "resumed.exr");
    EXPECT_EQ(read_file(file), bytes) << part;
    EXPECT_FALSE(fs::exists(unfinished_bake(file)));
  }
}

// A kill before the first tiles are written, and a computer that loses power.
TEST_F(BakeFile, GoesOnFromFilesWithoutTilesOrWithZeros) {
  const std::string bytes = whole();
  const std::size_t table = *renderer::end_of_exr_header(folder_ / "whole.exr");
  const std::size_t tiles = std::size_t(renderer::ExrChunks(folder_ / "whole.exr").count());
  const std::size_t first = table + 8 * tiles, end = bytes.size() / 4096 * 4096 * 3 / 5;
  std::string without_table = bytes;
  std::fill_n(without_table.begin() + std::ptrdiff_t(table), 8 * tiles, '\0');
  const auto zeros = [&](std::size_t from) { return without_table.substr(0, from) + std::string(end - from, '\0'); };
  for (const std::string& left : {zeros(0), bytes.substr(0, table), bytes.substr(0, table + 9),
                                  bytes.substr(0, first - 1), zeros(first), zeros(end / 2 / 4096 * 4096)}) {
    const fs::path file = folder_ / "resumed.exr";
    std::ofstream(unfinished_bake(file), std::ios::binary) << left;
    bake_as({.shard = {}, .resume = true}, "resumed.exr");
    EXPECT_EQ(read_file(file), bytes) << left.size();
  }
}

TEST_F(BakeFile, KeepsWhatIsDoneWhenInterrupted) {
  std::atomic<bool> interrupted{false};
  renderer::Control control;
  control.interrupted = &interrupted;
  control.report = [&](std::string_view, double fraction) { interrupted = interrupted || fraction > 0.6; };
  EXPECT_THROW(bake_as({}, "stopped.exr", 26e6, control), renderer::Interruption);
  EXPECT_FALSE(fs::exists(folder_ / "stopped.exr"));
  ASSERT_TRUE(fs::exists(unfinished_bake(folder_ / "stopped.exr")));
  double first = 1;
  control.report = [&](std::string_view, double fraction) { first = std::min(first, fraction); };
  interrupted = false;
  EXPECT_EQ(read_file(bake_as({.shard = {}, .resume = true}, "stopped.exr", 26e6, control)), whole());
  EXPECT_GT(first, 0.05);
}

TEST_F(BakeFile, WritesThroughNothingThatHasItsName) {
  const fs::path unfinished = unfinished_bake(folder_ / "baked.exr"), precious = folder_.write("precious", "precious");
  const Shard part{0, 16};
  const std::string expected = read_file(bake_as({.shard = part}, "expected.exr"));
  fs::create_symlink(precious, unfinished);
  EXPECT_EQ(read_file(bake_as({.shard = part}, "baked.exr")), expected);
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder_ / "baked.exr")));
  fs::create_hard_link(precious, unfinished);
  EXPECT_THROW(bake_as({.shard = part, .resume = true}, "baked.exr"), Error) << "it is no cache";
  EXPECT_EQ(read_file(bake_as({.shard = part}, "baked.exr")), expected);
  EXPECT_EQ(read_file(precious), "precious");
  fs::create_symlink(unfinished.filename(), unfinished);
  try {
    bake_as({.shard = part, .resume = true}, "baked.exr");
    FAIL() << "a link to itself";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("is not a file"), std::string::npos) << e.what();
  }
  fs::remove(unfinished);
  ASSERT_EQ(::mkfifo(unfinished.c_str(), 0600), 0);
  EXPECT_THROW(bake_as({.shard = part, .resume = true}, "baked.exr"), Error);
  EXPECT_EQ(read_file(bake_as({.shard = part}, "baked.exr")), expected);
}

// What was baked by another version, or is no cache at all, may be of use to somebody.
TEST_F(BakeFile, DoesNotGoOnWithWhatItCannotRead) {
  const fs::path unfinished = unfinished_bake(folder_ / "other.exr");
  std::string other = whole();
  const std::size_t version = other.find("chiaro:format_version");
  ASSERT_NE(version, std::string::npos);
  other[version + std::strlen("chiaro:format_version") + 1 + sizeof("int") + 4] += 1;  // name, type, size, value
  for (const std::string& bytes : {other, std::string("no cache at all")}) {
    std::ofstream(unfinished, std::ios::binary) << bytes;
    EXPECT_THROW(bake_as({.shard = {}, .resume = true}, "other.exr"), Error);
    EXPECT_EQ(read_file(unfinished), bytes);
  }
}

TEST_F(BakeFile, DoesNotGoOnWithAnother) {
  fs::copy(folder_ / "whole.exr", unfinished_bake(folder_ / "other.exr"));
  settings_.seed = 6;
  EXPECT_THROW(bake_as({.shard = {}, .resume = true}, "other.exr"), Error);
  EXPECT_FALSE(fs::exists(folder_ / "other.exr"));
  EXPECT_NO_THROW(bake_as({}, "other.exr"));
}

// The header of a bake that knows more of its grid has all that the one asked for has.
TEST_F(BakeFile, DoesNotGoOnWithFinerCells) {
  LightGrid finer = make_light_grid(tracer_, {.counts = {12, 11, 10}, .region = {}});
  set_finer_cells(finer, {{1, 7}, {1, 95}});
  Baker baker(tracer_, receivers_, finer, settings_, kAllMemory);
  bake_to_file(baker, folder_ / "finer.exr", {}, {});
  fs::rename(folder_ / "finer.exr", unfinished_bake(folder_ / "other.exr"));
  EXPECT_THROW(bake_as({.shard = {}, .resume = true}, "other.exr"), Error);
}

TEST_F(BakeFile, PartsMakeTheWhole) {
  std::vector<fs::path> parts;
  for (const std::size_t i : {2, 0, 3, 1}) {
    parts.push_back(bake_as({.shard = {i, 4}, .resume = false}, "part" + std::to_string(i) + ".exr"));
  }
  merge_transport_caches(parts, folder_ / "merged.exr", {});
  EXPECT_EQ(read_file(folder_ / "merged.exr"), whole());
  EXPECT_THROW(load_transport_cache(parts[0]), Error);
  for (const std::size_t i : {0, 500'000, 999'999}) {
    EXPECT_THROW(bake_as({.shard = {i, 1'000'000}, .resume = false}, "none.exr"), Error) << i;
  }
}

constexpr std::pair<int, int> kTilings[] = {{3, 5}, {100, 64}, {7, 1500}, {1024, 2048}};

TEST_F(BakeFile, PartsInTilesOfAnySizeMakeTheWhole) {
  const int all = int(receivers_.size()), half = all / 2;
  for (const auto& [width, height] : kTilings) {
    const fs::path first = columns(folder_ / "whole.exr", "0.exr", {width, height, 0, half});
    const fs::path second = columns(folder_ / "whole.exr", "1.exr", {height, width, half, all});
    merge_transport_caches(std::vector{second, first}, folder_ / "merged.exr", {});
    EXPECT_EQ(read_file(folder_ / "merged.exr"), whole()) << width << " x " << height;
  }
}

// Tiles of the whole have several receivers where lights are few.
TEST_F(BakeFile, PartsThatBeginWithinATileMakeTheWhole) {
  const LightGrid grid = make_light_grid(tracer_, {.counts = {3, 3, 3}, .region = {}});
  ASSERT_GT(TransportCacheWriter::receivers_of_tile(grid.positions.size()), 16U);
  const int all = int(receivers_.size());
  ASSERT_GT(all, 120);
  Baker baker(tracer_, receivers_, grid, settings_, kAllMemory);
  bake_to_file(baker, folder_ / "few.exr", {}, {});
  for (const int width : {1, 50, 4096}) {
    std::vector<fs::path> parts;
    parts.push_back(columns(folder_ / "few.exr", "0.exr", {width, 8, 0, 50}));
    parts.push_back(columns(folder_ / "few.exr", "1.exr", {width, 8, 50, 53}));
    parts.push_back(columns(folder_ / "few.exr", "2.exr", {width, 8, 53, all}));
    merge_transport_caches(parts, folder_ / "merged.exr", {});
    EXPECT_EQ(read_file(folder_ / "merged.exr"), read_file(folder_ / "few.exr")) << width;
  }
}

TEST_F(BakeFile, GoesOnFromTilesOfAnySize) {
  const fs::path file = folder_ / "resumed.exr";
  for (const auto& [width, height] : kTilings) {
    test::retile(folder_ / "whole.exr", folder_ / "retiled.exr", width, height);
    const std::string bytes = read_file(folder_ / "retiled.exr");
    for (const double part : {0.4, 1.0}) {
      std::ofstream(unfinished_bake(file), std::ios::binary)
          << bytes.substr(0, std::size_t(part * double(bytes.size())));
      bake_as({.shard = {}, .resume = true}, "resumed.exr");
      EXPECT_EQ(read_file(file), whole()) << width << " x " << height << ", " << part;
    }
  }
}

TEST_F(BakeFile, PartsThatDoNotFitAreRefused) {
  const auto part = [&](std::size_t i, const std::string& name) {
    return bake_as({.shard = {i, 2}, .resume = false}, name);
  };
  const fs::path first = part(0, "0.exr"), second = part(1, "1.exr"), merged = folder_ / "merged.exr";
  const auto refused = [&](const std::vector<fs::path>& parts) {
    EXPECT_THROW(merge_transport_caches(parts, merged, {}), Error);
    EXPECT_FALSE(fs::exists(merged));
  };
  refused({first});
  refused({second});
  refused({first, second, second});
  refused({first, folder_ / "whole.exr"});
  refused({first, folder_ / "missing.exr"});
  settings_.seed = 6;
  refused({first, part(1, "other.exr")});
  const std::string bytes = read_file(second);
  refused({first, folder_.write("cut.exr", bytes.substr(0, bytes.size() / 2))});
}

}  // namespace
}  // namespace chiaro::inverse

#include "inverse/transport/transport_cache.h"

#include <cstring>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "inverse/transport/transport_cache_header.h"
#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/sampler.h"
#include "renderer/image/image_file.h"
#include "tests/support/error_of.h"
#include "tests/support/retile.h"
#include "tests/support/save_transport_cache.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::inverse {
namespace {

namespace fs = std::filesystem;
using renderer::Error;
using renderer::Sampler;

// 3 × 2 × 2 nodes, two of them left out, and three lights in finer cells; entries of many magnitudes up to `largest`.
TransportCache make_cache(float largest) {
  TransportCache cache;
  LightGrid& grid = cache.grid;
  grid.region = {{-1, 0.1F, 2}, {5, 3, 4.5F}};
  grid.counts = {3, 2, 2};
  grid.spacing = {2, 1.45F, 1.25F};
  grid.origin = {0, 0.825F, 2.625F};
  for (int node = 0; node < 12; ++node) {
    const bool left_out = node == 4 || node == 5;
    grid.light_of_node.push_back(left_out ? -1 : int(grid.positions.size()));
    if (!left_out) {
      grid.positions.push_back(grid.origin +
                               grid.spacing * Vec3f{float(node % 3), float(node / 3 % 2), float(node / 6)});
    }
  }
  set_finer_cells(grid, {{1, 7}, {1, 95}, {3, 6000}});
  cache.receiver_count = 37;
  for (std::uint32_t i = 0; i < 13 * 37; ++i) {
    Sampler sampler(1, i, 0);
    const float magnitude = largest * std::exp2(-20 * sampler.next_1d());
    const renderer::Vec2f xy = sampler.next_2d();
    cache.visibility.push_back(sampler.next_1d() < 0.5F ? 1 : 0);
    cache.indirect.push_back(magnitude * Vec3f{xy.x, xy.y, i % 7 == 0 ? 0.0F : 1.0F});
  }
  cache.indirect[5] = {largest, 0, 0};
  cache.scene_fingerprint = "0123456789abcdef";
  cache.receiver_fingerprint = "fedcba9876543210";
  cache.settings = {.samples = 77, .bounces = 3, .seed = 0xfedcba9876543210ULL, .materials = "albedo 0.5,0.5,0.25"};
  cache.indirect_relative_error = 0.0123;
  cache.indirect_scale = std::exp2(std::floor(std::log2(1000 / largest)));
  return cache;
}

class TransportCacheFile : public ::testing::Test {
 protected:
  fs::path path() const { return folder_.path() / "cache.exr"; }

  // Saves the cache with its file's header or pixels changed by edit(file).
  template <class Edit>
  void save_edited(const Edit& edit) const {
    save_transport_cache(make_cache(1), path());
    renderer::ImageFile file = renderer::load_image(path());
    edit(file);
    renderer::save_image(file.image, path(), renderer::PixelType::kHalf, file.attributes);
  }

  template <class Value>
  void save_with(const std::string& name, const Value& value) const {
    save_edited([&](renderer::ImageFile& file) {
      for (auto& [key, old] : file.attributes) {
        if (key == "chiaro:" + name) old = value;
      }
    });
  }

  void expect_refused(const std::string& why) const {
    try {
      load_transport_cache(path());
      ADD_FAILURE() << why << " was taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.parts().file, path().string()) << why;
      EXPECT_FALSE(error.parts().problem.empty()) << why;
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(TransportCacheFile, KeepsEverythingInItsHeader) {
  const TransportCache cache = make_cache(1);
  save_transport_cache(cache, path());
  for (const TransportCache& read : {load_transport_cache_header(path()), load_transport_cache(path())}) {
    EXPECT_EQ(read.receiver_count, cache.receiver_count);
    EXPECT_EQ(read.grid.region.min, cache.grid.region.min);
    EXPECT_EQ(read.grid.region.max, cache.grid.region.max);
    EXPECT_EQ(read.grid.origin, cache.grid.origin);
    EXPECT_EQ(read.grid.spacing, cache.grid.spacing);
    EXPECT_EQ(read.grid.counts, cache.grid.counts);
    EXPECT_EQ(read.grid.light_of_node, cache.grid.light_of_node);
    EXPECT_EQ(read.grid.finer, cache.grid.finer);
    EXPECT_EQ(read.grid.positions, cache.grid.positions);
    EXPECT_EQ(read.scene_fingerprint, cache.scene_fingerprint);
    EXPECT_EQ(read.receiver_fingerprint, cache.receiver_fingerprint);
    EXPECT_EQ(read.settings.samples, cache.settings.samples);
    EXPECT_EQ(read.settings.bounces, cache.settings.bounces);
    EXPECT_EQ(read.settings.seed, cache.settings.seed);
    EXPECT_EQ(read.settings.materials, cache.settings.materials);
    EXPECT_FLOAT_EQ(float(read.indirect_relative_error), float(cache.indirect_relative_error));
  }
}

TEST_F(TransportCacheFile, KeepsEntriesToHalfPrecisionWhateverTheirMagnitude) {
  // Illumination per candela is 1e6 times a metre's in a scene of millimetres, and 1e-6 times in one of kilometres.
  for (const float largest : {1e-12F, 1e-6F, 0.3F, 1.0F, 1e6F, 1e12F}) {
    const TransportCache cache = make_cache(largest);
    save_transport_cache(cache, path());
    const TransportCache read = load_transport_cache(path());
    EXPECT_EQ(read.visibility, cache.visibility);
    ASSERT_EQ(read.indirect.size(), cache.indirect.size());
    for (std::size_t i = 0; i < cache.indirect.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        // Half a step of a 10-bit fraction; below a millionth of the largest the steps no longer shrink.
        const float bound = cache.indirect[i][c] / 2000 + 1e-10F * largest;
        EXPECT_NEAR(read.indirect[i][c], cache.indirect[i][c], bound) << largest;
      }
    }
  }
}

TEST_F(TransportCacheFile, ReadsTheColumnsAskedFor) {
  save_transport_cache(make_cache(1), path());
  const TransportCache all = load_transport_cache(path());
  const std::vector<std::size_t> chosen{0, 5, 6, 36};
  const TransportCache some = load_transport_cache(path(), chosen);
  ASSERT_EQ(some.receiver_count, 4U);
  for (std::size_t light = 0; light < all.grid.positions.size(); ++light) {
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(some.indirect[light * 4 + i], all.indirect[light * 37 + chosen[i]]);
      EXPECT_EQ(some.visibility[light * 4 + i], all.visibility[light * 37 + chosen[i]]);
    }
  }
}

TEST_F(TransportCacheFile, ReadsTilesOfAnySize) {
  save_transport_cache(make_cache(1), path());
  const TransportCache all = load_transport_cache(path());
  const std::vector<std::size_t> chosen{0, 5, 6, 21, 36};
  const TransportCache some = load_transport_cache(path(), chosen);
  const fs::path retiled = folder_ / "retiled.exr";
  for (const auto& [width, height] :
       {std::pair{1, 1}, {5, 4}, {36, 13}, {37, 1}, {7, 4096}, {4096, 2}, {1, 1 << 20}, {1 << 20, 1}, {1024, 1024}}) {
    test::retile(path(), retiled, width, height);
    EXPECT_EQ(load_transport_cache_header(retiled).receiver_count, 37U);
    EXPECT_EQ(load_transport_cache(retiled).visibility, all.visibility) << width << " x " << height;
    EXPECT_EQ(load_transport_cache(retiled).indirect, all.indirect) << width << " x " << height;
    EXPECT_EQ(load_transport_cache(retiled, chosen).visibility, some.visibility) << width << " x " << height;
    EXPECT_EQ(load_transport_cache(retiled, chosen).indirect, some.indirect) << width << " x " << height;
  }
}

TEST_F(TransportCacheFile, ReadsScanlineFilesOfOthers) {
  save_edited([](renderer::ImageFile&) {});  // as any program writes them
  ASSERT_FALSE(renderer::ExrTileReader::is_tiled(path()));
  const TransportCache read = load_transport_cache(path()), expected = make_cache(1);
  EXPECT_EQ(read.visibility, expected.visibility);
  for (std::size_t i = 0; i < expected.indirect.size(); ++i) {
    EXPECT_NEAR(read.indirect[i].x, expected.indirect[i].x, expected.indirect[i].x / 2000 + 1e-9F);
    EXPECT_NEAR(read.indirect[i].z, expected.indirect[i].z, expected.indirect[i].z / 2000 + 1e-9F);
  }
}

TEST_F(TransportCacheFile, APartInScanlinesIsRefused) {
  save_edited([](renderer::ImageFile&) {});
  const renderer::ImageFile file = renderer::load_image(path());
  std::string bytes = renderer::read_file(path());
  const std::string window("displayWindow\0box2i\0\x10\0\0\0", 24);
  const std::size_t at = bytes.find(window);
  ASSERT_NE(at, std::string::npos);
  const std::int32_t last = file.image.width;  // one receiver more than there are
  std::memcpy(&bytes[at + window.size() + 8], &last, sizeof last);
  renderer::write_file_atomically(path(), bytes);
  expect_refused("a data window within the display window");
}

TEST_F(TransportCacheFile, WithoutIndirectLightIsFine) {
  TransportCache cache = make_cache(1);
  for (Vec3f& v : cache.indirect) v = {};
  save_transport_cache(cache, path());
  EXPECT_EQ(load_transport_cache(path()).indirect, cache.indirect);
}

TEST_F(TransportCacheFile, TruncatedAnywhereIsRefused) {
  save_transport_cache(make_cache(1), path());
  const std::string bytes = renderer::read_file(path());
  for (const double part : {0.0, 0.02, 0.3, 0.6, 0.9, 0.99}) {
    std::ofstream(path(), std::ios::binary) << bytes.substr(0, std::size_t(part * double(bytes.size())));
    expect_refused("a file cut to " + std::to_string(part));
  }
}

TEST_F(TransportCacheFile, OtherFilesAreRefused) {
  expect_refused("a missing file");
  std::ofstream(path()) << "not an image";
  expect_refused("a text");
  renderer::save_image(renderer::make_image(8, 8, {"R", "G", "B"}), path(), renderer::PixelType::kHalf);
  expect_refused("a frame");
}

TEST_F(TransportCacheFile, HeadersThatDoNotFitAreRefused) {
  save_with("kind", std::string("frame"));
  expect_refused("another kind");
  save_with("format_version", 99);
  expect_refused("another version");
  for (const char* counts : {"3,2,3", "3,2", "", "3,2,0", "3,-2,2", "a,b,c", "3,2,2,2", "99999999999,1,1"}) {
    save_with("grid_counts", std::string(counts));
    expect_refused(std::string("grid_counts ") + counts);
  }
  for (const char* nodes : {"0-11", "0-3", "0-3,6-12", "", "x", "0-3,6-10,99999"}) {
    save_with("grid_nodes", std::string(nodes));
    expect_refused(std::string("grid_nodes ") + nodes);
  }
  for (const char* cells : {"7", "7,96", "", "x"}) {
    save_with("grid_finer_1", std::string(cells));
    expect_refused(std::string("grid_finer_1 ") + cells);
  }
  for (const float scale : {0.0F, -1.0F, renderer::kInfinity, std::nanf("")}) {
    save_with("indirect_scale", scale);
    expect_refused("indirect_scale " + std::to_string(scale));
  }
  for (const int samples : {0, -1, 1 << 30}) {
    save_with("samples", samples);
    expect_refused("samples " + std::to_string(samples));
  }
  save_with("seed", std::string("many"));
  expect_refused("a seed that is no number");
  save_with("samples", std::string("77"));
  expect_refused("an attribute of another type");
}

TEST_F(TransportCacheFile, ValuesOutOfRangeAreRefusedByName) {
  const auto refused = [&](const std::string& name) {
    const std::string message = test::error_of([&] { load_transport_cache(path()); });
    EXPECT_NE(message.find("chiaro:" + name), std::string::npos) << name << ": " << message;
  };
  for (const int bounces : {-2, 10001, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()}) {
    save_with("bounces", bounces);
    refused("bounces");
  }
  for (const float error : {-1e-6F, -renderer::kInfinity, renderer::kInfinity, std::nanf("")}) {
    save_with("indirect_relative_error", error);
    refused("indirect_relative_error");
  }
  for (const int bounces : {-1, 0, 10000}) {
    save_with("bounces", bounces);
    EXPECT_EQ(load_transport_cache(path()).settings.bounces, bounces);
  }
}

// Their nodes and cells fit the grid, but are more than there are rows.
TEST_F(TransportCacheFile, NumbersBeyondTheRowsAreRefusedByName) {
  const auto refused = [&](const char* name, const char* numbers) {
    save_with(name, std::string(numbers));
    const std::string message = test::error_of([&] { load_transport_cache(path()); });
    EXPECT_NE(message.find(std::string("chiaro:") + name), std::string::npos) << numbers << ": " << message;
  };
  refused("grid_finer_1", "0-95");
  refused("grid_finer_3", "0-6000");
  TransportCache cache = make_cache(1);
  cache.grid = {};
  cache.grid.region = {{0, 0, 0}, {464, 464, 464}};
  cache.grid.counts = {464, 464, 464};
  cache.grid.spacing = {1, 1, 1}, cache.grid.origin = {0.5F, 0.5F, 0.5F};
  cache.grid.light_of_node = {0};
  renderer::Attributes attributes = transport_cache_attributes(cache);
  attributes.emplace_back("chiaro:grid_finer_1", std::string("0-99999999"));
  const std::string message = test::error_of([&] { transport_cache_from(attributes, 1, 1, "huge.exr"); });
  EXPECT_NE(message.find("chiaro:grid_finer_1"), std::string::npos) << message;
}

// So that what is written can be read.
TEST_F(TransportCacheFile, AnErrorBeyondAllFloatsIsWrittenAsTheLargest) {
  TransportCache cache = make_cache(1);
  cache.indirect_relative_error = std::numeric_limits<double>::infinity();
  save_transport_cache(cache, path());
  EXPECT_EQ(load_transport_cache(path()).indirect_relative_error, double(std::numeric_limits<float>::max()));
}

// Rays to there would have no direction.
TEST_F(TransportCacheFile, RegionsBeyondTheWorldAreRefused) {
  TransportCache cache = make_cache(1);
  for (const float far : {1e8F, 1e19F, 1e30F}) {
    cache.grid = {};
    cache.grid.region = {{-far, -far, -far}, {far, far, far}};
    cache.grid.counts = {1, 1, 1};
    cache.grid.spacing = {2 * far, 2 * far, 2 * far};
    cache.grid.light_of_node = {0};
    const renderer::Attributes attributes = transport_cache_attributes(cache);
    const std::string message = test::error_of([&] { transport_cache_from(attributes, 1, 1, "far.exr"); });
    EXPECT_EQ(message.find("beyond the world") != std::string::npos, far > 1e9F) << message;
  }
}

TEST_F(TransportCacheFile, RegionsMayBeFlatButNoPoint) {
  TransportCache cache = make_cache(1);
  for (const Vec3f size : {Vec3f{1, 1, 1}, {1, 0, 1}, {1, 0, 0}, {0, 0, 0}}) {
    cache.grid = {};
    cache.grid.region = {{1, 1, 1}, Vec3f{1, 1, 1} + size};
    cache.grid.origin = Vec3f{1, 1, 1} + 0.5F * size;
    cache.grid.counts = {1, 1, 1};
    cache.grid.spacing = size;
    cache.grid.light_of_node = {0};
    const renderer::Attributes attributes = transport_cache_attributes(cache);
    const std::string message = test::error_of([&] { transport_cache_from(attributes, 1, 1, "flat.exr"); });
    EXPECT_EQ(message.empty(), size.x > 0) << message;
  }
}

TEST_F(TransportCacheFile, MissingAttributesAreRefusedByName) {
  for (const char* name :
       {"kind", "format_version", "region_min", "grid_nodes", "scene_fingerprint", "indirect_scale"}) {
    save_edited([&](renderer::ImageFile& file) {
      std::erase_if(file.attributes, [&](const auto& a) { return a.first == std::string("chiaro:") + name; });
    });
    try {
      load_transport_cache(path());
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_NE(error.parts().problem.find(name), std::string::npos) << error.what();
    }
  }
}

// Of some light at some receiver.
float& sample(renderer::ImageFile& file, const char* channel) {
  const std::vector<std::string>& names = file.image.channel_names;
  return file.image.pixels[4 * 40 + std::size_t(std::find(names.begin(), names.end(), channel) - names.begin())];
}

TEST_F(TransportCacheFile, PixelsThatAreNoNumbersOrChannelsThatLackAreRefused) {
  save_edited([](renderer::ImageFile& file) { sample(file, "indirect.G") = std::nanf(""); });
  expect_refused("a pixel that is not a number");
  save_edited([](renderer::ImageFile& file) { sample(file, "indirect.G") = renderer::kInfinity; });
  expect_refused("an infinite pixel");
  for (const float visibility : {std::nanf(""), renderer::kInfinity, -renderer::kInfinity}) {
    save_edited([=](renderer::ImageFile& file) { sample(file, "visibility") = visibility; });
    expect_refused("a visibility that is not finite");
  }
  for (const float visibility : {-1.0F, 0.25F, 0.75F, 2.0F}) {
    save_edited([=](renderer::ImageFile& file) { sample(file, "visibility") = visibility; });
    expect_refused("a visibility that is neither 0 nor 1");
  }
  save_edited([](renderer::ImageFile& file) { sample(file, "indirect.B") = -0.5F; });
  expect_refused("light that is negative");
  save_edited([](renderer::ImageFile& file) {
    for (std::string& name : file.image.channel_names) name = name == "indirect.G" ? "other" : name;
  });
  expect_refused("a missing channel");
}

TEST_F(TransportCacheFile, ChangedBytesNeverCrash) {
  // One byte of the header after the other; either the change shows in what is read, or the file is refused.
  save_transport_cache(make_cache(1), path());
  const std::string bytes = renderer::read_file(path());
  int refused = 0;
  for (std::size_t i = 8; i < std::min<std::size_t>(bytes.size(), 1600); i += 7) {
    std::string changed = bytes;
    changed[i] = char(changed[i] ^ 0x15);
    std::ofstream(path(), std::ios::binary) << changed;
    try {
      const TransportCache read = load_transport_cache(path());
      EXPECT_EQ(read.indirect.size(), read.receiver_count * read.grid.positions.size());
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 20);
}

}  // namespace
}  // namespace chiaro::inverse

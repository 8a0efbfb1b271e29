// Arrays as data URIs. The base64 expected was made by Python's base64 and struct modules.

#include "inverse/solve/packed_values.h"

#include <gtest/gtest.h>

namespace chiaro::inverse {
namespace {

std::string uri(const std::string& base64) { return "data:application/octet-stream;base64," + base64; }

TEST(PackedValues, AreLittleEndianBinary) {
  EXPECT_EQ(pack_floats({{1, -2, 0.5F}}), uri("AACAPwAAAMAAAAA/"));
  EXPECT_EQ(pack_indices({1, 258}), uri("AQAAAAIBAAA="));
  EXPECT_EQ(pack_triangles({{0, 2, 1}}), uri("AAAAAAIAAAABAAAA"));
}

TEST(PackedValues, PositionsSpanTheirBox) {
  const renderer::Box3f box{{-1, 0, 5}, {1, 4, 5}};
  EXPECT_EQ(pack_within({{-1, 4, 5}, {1, 2, 5}}, box), uri("AAD//wAA//8AgAAA"));
}

TEST(PackedValues, HalvesAreScaled) { EXPECT_EQ(pack_halves({{2, -1, 0.2F}}, 2), uri("ADwAuGYu")); }

TEST(PackedValues, BytesAreClamped) {
  EXPECT_EQ(pack_bytes(std::vector<double>{-1, 0, 1, 2, 3}, 2), uri("AACA//8="));
  EXPECT_EQ(pack_bytes(std::vector<float>{0, 0}, 0), uri("AAA="));
}

TEST(PackedValues, MayBeNone) { EXPECT_EQ(pack_floats({}), uri("")); }

}  // namespace
}  // namespace chiaro::inverse

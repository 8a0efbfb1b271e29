#include "inverse/transport/number_ranges.h"

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"

namespace chiaro::inverse {
namespace {

using Numbers = std::vector<int>;

constexpr std::size_t kMany = 1'000'000'000;

TEST(NumberRanges, WriteRunsAsRanges) {
  EXPECT_EQ(format_number_ranges({0, 1, 2, 7}), "0-2,7");
  EXPECT_EQ(format_number_ranges({5}), "5");
  EXPECT_EQ(format_number_ranges({3, 4, 10, 11, 13}), "3-4,10-11,13");
  EXPECT_EQ(format_number_ranges({}), "");
}

TEST(NumberRanges, ReadWhatTheyWrote) {
  for (std::uint32_t k = 0; k < 200; ++k) {
    Numbers numbers;
    for (std::uint32_t i = 0; i < 300; ++i) {
      renderer::Sampler sampler(1, k, i);
      if (sampler.next_1d() < float(k) / 199) numbers.push_back(int(i) * (k % 3 == 0 ? 1000 : 1));
    }
    EXPECT_EQ(parse_number_ranges(format_number_ranges(numbers), numbers.size()), numbers);
  }
}

TEST(NumberRanges, RefuseWhatIsMalformedOrNotAscending) {
  for (const char* text : {"a", "1-", "-1", "1,,2", ",1", "1,", "1-2-3", "3,2", "2,2", "0-5,5", "5-3", "1 2", "1, 2",
                           "1.5", "99999999999", "1-99999999999"}) {
    EXPECT_FALSE(parse_number_ranges(text, kMany).has_value()) << text;
  }
}

TEST(NumberRanges, OfMoreNumbersThanAreWantedAreRefused) {
  EXPECT_EQ(parse_number_ranges("0-2,7", 4), (Numbers{0, 1, 2, 7}));
  for (const char* text : {"0-3", "0,1,2,3", "0-1,5-6", "0-99999999", "5,7-99999999"}) {
    EXPECT_FALSE(parse_number_ranges(text, 3).has_value()) << text;
  }
  EXPECT_EQ(parse_number_ranges("", 0), Numbers{});
  EXPECT_FALSE(parse_number_ranges("0", 0).has_value());
}

}  // namespace
}  // namespace chiaro::inverse

#include "renderer/core/fingerprint.h"

#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace chiaro::renderer {
namespace {

std::string of_bytes(const std::vector<unsigned char>& bytes) {
  Fingerprint f;
  f.add_all(std::span<const unsigned char>(bytes));
  return f.text();
}

TEST(Fingerprint, IsSixteenHexadecimalDigits) {
  const std::string text = of_bytes({1, 2, 3});
  EXPECT_EQ(text.size(), 16U);
  EXPECT_EQ(text.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(text, of_bytes({1, 2, 3}));
}

TEST(Fingerprint, DiffersOnAnyChangedBitOfAnyByte) {
  std::set<std::string> seen;
  std::size_t made = 0;
  for (std::size_t size = 0; size <= 40; ++size) {
    const std::vector<unsigned char> zeros(size, 0);
    seen.insert(of_bytes(zeros)), ++made;
    for (std::size_t i = 0; i < size; ++i) {
      for (int bit = 0; bit < 8; ++bit) {
        std::vector<unsigned char> changed = zeros;
        changed[i] = static_cast<unsigned char>(1U << bit);
        seen.insert(of_bytes(changed)), ++made;
      }
    }
  }
  EXPECT_EQ(seen.size(), made);
}

TEST(Fingerprint, DiffersByOrder) {
  const auto of_pair = [](std::uint64_t a, std::uint64_t b) {
    Fingerprint f;
    f.add(a);
    f.add(b);
    return f.text();
  };
  EXPECT_NE(of_pair(1, 2), of_pair(2, 1));
  EXPECT_NE(of_pair(0, 1), of_pair(1, 0));
  EXPECT_NE(of_bytes({1, 2}), of_bytes({2, 1}));
}

TEST(Fingerprint, KnowsWhereOneListEndsAndTheNextBegins) {
  const auto of_two = [](const std::string& a, const std::string& b) {
    Fingerprint f;
    f.add(a);
    f.add(b);
    return f.text();
  };
  EXPECT_NE(of_two("ab", "c"), of_two("a", "bc"));
  EXPECT_NE(of_two("", "abc"), of_two("abc", ""));
}

}  // namespace
}  // namespace chiaro::renderer

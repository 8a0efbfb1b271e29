#pragma once

#include <cctype>
#include <string>

namespace chiaro::test {

// `text` as the name of a value-parameterised test, of which gtest allows letters, digits and '_': --width -5 becomes
// width_5.
inline std::string test_name(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool allowed = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (allowed) name += c;
    if (!allowed && !name.empty() && name.back() != '_') name += '_';
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name.empty() ? "nothing" : name;
}

// For INSTANTIATE_TEST_SUITE_P: by the parameter's own text, or by its `name`.
inline constexpr auto kByText = [](const auto& info) { return test_name(info.param); };
inline constexpr auto kByName = [](const auto& info) { return test_name(info.param.name); };

}  // namespace chiaro::test

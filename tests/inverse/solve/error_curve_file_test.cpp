#include "inverse/solve/error_curve_file.h"

#include <gtest/gtest.h>

#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::inverse {
namespace {

std::vector<LightSet> load_text(const std::string& text) {
  const test::TemporaryFolder folder;
  return load_error_curve(folder.write("solve.json", text));
}

std::string error_of(const std::string& text) {
  return test::error_of([&] { load_text(text); });
}

TEST(ErrorCurveFile, HasTheLightsOfEverySet) {
  const auto sets = load_text(R"({"version":"of another day","error_curve":[
      {"relative_l2":0.5,"lights":[{"position":[1,2,3],"intensity":[4,5,6]}]},
      {"lights":[{"position":[1,2,3],"intensity":[1,0,2]},{"position":[7,8,9],"intensity":[0,0,1]}]}]})");
  ASSERT_EQ(sets.size(), 2U);
  EXPECT_EQ(sets[0].relative_l2, 0.5);
  ASSERT_EQ(sets[1].lights.size(), 2U);
  EXPECT_EQ(sets[0].lights[0].intensity, (renderer::Vec3f{4, 5, 6}));
  EXPECT_EQ(sets[1].lights[1].position, (renderer::Vec3f{7, 8, 9}));
}

TEST(ErrorCurveFile, FaultsAreToldWithTheirPlace) {
  const std::string set = R"({"error_curve":[{"lights":[{"position":[1,2,3],"intensity":[4,5,6]}]},)";
  const std::pair<std::string, std::string> faults[] = {
      {"[]", "solve.json: is an array with 0 inside (expected an object)"},
      {"{}", "has no \"error_curve\" (expected the summary of a solve, by --json)"},
      {R"({"error_curve":7})", "error_curve: is 7 (expected a list of sets of lights)"},
      {R"({"error_curve":[]})",
       "error_curve: has no sets of lights (expected the summary of a solve with --method joint"},
      {set + R"({"lights":[]}]})", "error_curve[1].lights: "},
      {set + R"({"lights":[{"position":[1,2],"intensity":[4,5,6]}]}]})", "error_curve[1].lights[0].position: "},
      {set + R"({"lights":[{"position":[1,2,3e9],"intensity":[4,5,6]}]}]})",
       "error_curve[1].lights[0].position: is too far away (expected a place within 1e+09 m of the origin)"},
      {set + R"({"lights":[{"position":[1,2,3],"intensity":[4,-5,6]}]}]})", "error_curve[1].lights[0].intensity"},
  };
  for (const auto& [text, said] : faults) EXPECT_NE(error_of(text).find(said), std::string::npos) << error_of(text);
}

}  // namespace
}  // namespace chiaro::inverse

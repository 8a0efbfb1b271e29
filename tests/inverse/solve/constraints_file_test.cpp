#include <gtest/gtest.h>

#include "inverse/solve/light_constraints.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::inverse {
namespace {

LightConstraints load_text(const std::string& text) {
  const test::TemporaryFolder folder;
  return load_constraints(folder.write("constraints.json", text));
}

std::string error_of(const std::string& text) {
  return test::error_of([&] { load_text(text); });
}

TEST(ConstraintsFile, ReadsEveryField) {
  const LightConstraints c = load_text(R"({"lights":3,"max_lights":5,
      "regions":["Room",[0,1,2,3.5,4,5],{"on":"Ceiling","clearance":0.25},{"on":"Wall"}],
      "surface_distance":0.125,"light_distance":0.5,"max_intensity":800,"kelvin":[2700,6500],
      "one_color":true,"keep_lights":true,"keep_positions":false})");
  EXPECT_EQ(c.lights, 3);
  EXPECT_EQ(c.max_lights, 5);
  ASSERT_EQ(c.regions.size(), 2U);
  EXPECT_EQ(c.regions[0].text, "Room");
  EXPECT_EQ(c.regions[1].text, "0,1,2,3.5,4,5");
  ASSERT_EQ(c.mounts.size(), 2U);
  EXPECT_EQ(c.mounts[0].node, "Ceiling");
  EXPECT_EQ(c.mounts[0].clearance, 0.25);
  EXPECT_FALSE(c.mounts[1].clearance);
  EXPECT_EQ(c.regions[1].asked_in.place, "regions[1]");
  EXPECT_EQ(c.mounts[1].asked_in.place, "regions[3]");
  EXPECT_EQ(c.surface_distance, 0.125);
  EXPECT_EQ(c.light_distance, 0.5);
  EXPECT_EQ(c.max_intensity, 800);
  EXPECT_EQ(c.kelvin, (std::array<double, 2>{2700, 6500}));
  EXPECT_TRUE(c.one_color);
  EXPECT_TRUE(c.keep_lights);
  EXPECT_FALSE(c.keep_positions);
}

TEST(ConstraintsFile, KeepsNumbersAsOptionsDo) {
  const LightConstraints c = load_text(
      R"({"regions":[{"on":"A","clearance":0.1}],"surface_distance":0.3,"max_intensity":4.1,"kelvin":[2700.1,6500.3]})");
  EXPECT_EQ(c.mounts[0].clearance, 0.1);
  EXPECT_EQ(c.surface_distance, 0.3);
  EXPECT_EQ(c.max_intensity, 4.1);
  EXPECT_EQ(c.kelvin, (std::array<double, 2>{2700.1, 6500.3}));
}

TEST(ConstraintsFile, FaultsAreNamedByPlace) {
  const std::pair<const char*, const char*> faults[] = {
      {"[]", "an object"},
      {R"({"light":3})", "unknown key \"light\""},
      {R"({"lights":0})", "lights"},
      {R"({"lights":2.5})", "a whole number"},
      {R"({"regions":[]})", "regions"},
      {R"({"regions":[[1,2,3]]})", "regions[0]"},
      {R"({"regions":[{"clearance":1}]})", "has no \"on\""},
      {R"({"regions":[{"on":"A","clearance":-1}]})", "regions[0].clearance"},
      {R"({"surface_distance":-1})", "surface_distance"},
      {R"({"kelvin":[6500,2700]})", "the first is higher"},
      {R"({"kelvin":[10,2700]})", "kelvin[0]"},
      {R"({"max_intensity":0})", "max_intensity"},
      {R"({"one_color":1})", "true or false"},
      {R"({"lights":3,"max_lights":2})", "lights 3 and max_lights 2 exclude each other"},
      {R"({"lights":3,"keep_positions":true})", "keep_positions and lights exclude"},
      {R"({"max_lights":3,"keep_positions":true})", "keep_positions and max_lights exclude"},
      {R"({"keep_lights":true,"keep_positions":true})", "keep_positions and keep_lights exclude"},
      {"{", "parse error"},
  };
  for (const auto& [text, part] : faults) EXPECT_NE(error_of(text).find(part), std::string::npos) << error_of(text);
}

}  // namespace
}  // namespace chiaro::inverse

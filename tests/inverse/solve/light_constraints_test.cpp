#include "inverse/solve/light_constraints.h"

#include <string>

#include <gtest/gtest.h>

namespace chiaro::inverse {
namespace {

TEST(LightConstraints, ContradictionsAreNamedAsTheUserCallsThem) {
  const auto shouted = [](const std::string& key) { return "<" + key + ">"; };
  LightConstraints constraints;
  constraints.lights = constraints.max_lights = 3;
  constraints.keep_lights = true;
  EXPECT_FALSE(find_contradiction(constraints, shouted));
  constraints.max_lights = 2;
  const auto too_many = find_contradiction(constraints, shouted);
  ASSERT_TRUE(too_many);
  EXPECT_EQ(too_many->key, "lights");
  EXPECT_EQ(too_many->reason, "<lights> 3 and <max_lights> 2 exclude each other");
  constraints.lights.reset();
  constraints.keep_positions = true;
  const auto both_kept = find_contradiction(constraints, shouted);
  ASSERT_TRUE(both_kept);
  EXPECT_EQ(both_kept->key, "keep_positions");
  EXPECT_EQ(both_kept->reason, "<keep_positions> and <keep_lights> exclude each other");
}

TEST(LightConstraints, OptionsComeFirst) {
  LightConstraints options, file;
  options.max_lights = 2;
  options.regions = {{"Here"}};
  file.max_lights = 7;
  file.light_distance = 1;
  file.regions = {{"There"}};
  file.mounts = {{"Ceiling", 0.1}};
  file.one_color = true;
  const LightConstraints both = merged(options, file);
  EXPECT_EQ(both.max_lights, 2);
  EXPECT_EQ(both.light_distance, 1);
  ASSERT_EQ(both.regions.size(), 1U);
  EXPECT_EQ(both.regions[0].text, "Here");
  EXPECT_TRUE(both.mounts.empty());
  EXPECT_TRUE(both.one_color);
}

}  // namespace
}  // namespace chiaro::inverse

#include <gtest/gtest.h>

#include "inverse/target/paint.h"
#include "renderer/core/error.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::inverse {
namespace {

using test::TemporaryFolder;

Strokes load_text(const std::string& text) {
  const TemporaryFolder folder;
  return load_strokes(folder.write("strokes.json", text));
}

TEST(StrokesFile, ReadsEveryField) {
  const Strokes strokes = load_text(R"({"base":"current","strokes":[
      {"mode":"multiply","color":[1,2.5,0],"radius":0.25,"falloff":"gaussian","opacity":0.5,
       "path":[[0,1,2],[3,-4,5e-1]],"distance":"space","mirror":{"point":[1,2,3],"normal":[0,-2,0]},"facing":false,"weight":2}]})");
  EXPECT_EQ(strokes.base, StrokeBase::kCurrent);
  ASSERT_EQ(strokes.strokes.size(), 1U);
  const Stroke& stroke = strokes.strokes[0];
  EXPECT_EQ(stroke.mode, BrushMode::kMultiply);
  EXPECT_EQ(stroke.color, (Vec3f{1, 2.5F, 0}));
  EXPECT_EQ(stroke.radius, 0.25F);
  EXPECT_EQ(stroke.falloff, BrushFalloff::kGaussian);
  EXPECT_EQ(stroke.opacity, 0.5F);
  EXPECT_EQ(stroke.path, (std::vector<Vec3f>{{0, 1, 2}, {3, -4, 0.5F}}));
  EXPECT_EQ(stroke.distance, BrushDistance::kSpace);
  ASSERT_TRUE(stroke.mirror.has_value());
  EXPECT_EQ(stroke.mirror->point, (Vec3f{1, 2, 3}));
  EXPECT_EQ(stroke.mirror->normal, (Vec3f{0, -1, 0}));
  EXPECT_FALSE(stroke.facing);
  EXPECT_EQ(stroke.weight, 2);
}

TEST(StrokesFile, WhatIsLeftOutHasTheDefaults) {
  const Strokes strokes =
      load_text(R"({"strokes":[{"color":[1,1,1],"path":[[0,0,0]]},{"mode":"erase","path":[[0,0,0]]}]})");
  EXPECT_EQ(strokes.base, StrokeBase::kBlack);
  const Stroke& stroke = strokes.strokes[0];
  EXPECT_EQ(stroke.mode, BrushMode::kAdd);
  EXPECT_EQ(stroke.radius, 0.3F);
  EXPECT_EQ(stroke.falloff, BrushFalloff::kSmooth);
  EXPECT_EQ(stroke.opacity, 1);
  EXPECT_EQ(stroke.distance, BrushDistance::kSurface);
  EXPECT_FALSE(stroke.mirror.has_value());
  EXPECT_TRUE(stroke.facing);
  EXPECT_EQ(stroke.weight, 1);
  EXPECT_EQ(strokes.strokes[1].mode, BrushMode::kErase);
}

TEST(StrokesFile, ReadsMirrorsAtCoordinatePlanes) {
  const std::pair<const char*, Vec3f> axes[] = {{"x", {1, 0, 0}}, {"y", {0, 1, 0}}, {"z", {0, 0, 1}}};
  for (const auto& [name, normal] : axes) {
    const std::string text =
        R"({"strokes":[{"mirror":")" + std::string(name) + R"(","color":[1,1,1],"path":[[0,0,0]]}]})";
    const Stroke stroke = load_text(text).strokes[0];
    ASSERT_TRUE(stroke.mirror.has_value());
    EXPECT_EQ(stroke.mirror->point, (Vec3f{0, 0, 0}));
    EXPECT_EQ(stroke.mirror->normal, normal);
  }
}

TEST(StrokesFile, ReadsEveryModeAndFalloff) {
  const std::pair<const char*, BrushMode> modes[] = {{"add", BrushMode::kAdd},
                                                     {"set", BrushMode::kSet},
                                                     {"multiply", BrushMode::kMultiply},
                                                     {"erase", BrushMode::kErase}};
  for (const auto& [name, mode] : modes) {
    const std::string text =
        R"({"strokes":[{"mode":")" + std::string(name) + R"(","color":[1,1,1],"path":[[0,0,0]]}]})";
    EXPECT_EQ(load_text(text).strokes[0].mode, mode) << name;
  }
  const std::pair<const char*, BrushFalloff> falloffs[] = {
      {"smooth", BrushFalloff::kSmooth}, {"hard", BrushFalloff::kHard}, {"gaussian", BrushFalloff::kGaussian}};
  for (const auto& [name, falloff] : falloffs) {
    const std::string text =
        R"({"strokes":[{"falloff":")" + std::string(name) + R"(","color":[1,1,1],"path":[[0,0,0]]}]})";
    EXPECT_EQ(load_text(text).strokes[0].falloff, falloff) << name;
  }
}

struct ErrorCase {
  std::string text;
  std::string place;
  std::string problem;  // a part of it
};

void expect_error(const ErrorCase& expected) {
  SCOPED_TRACE(expected.text.substr(0, 200));
  try {
    load_text(expected.text);
    ADD_FAILURE() << "no error";
  } catch (const renderer::Error& error) {
    EXPECT_EQ(error.parts().place, expected.place);
    EXPECT_NE(error.parts().problem.find(expected.problem), std::string::npos) << error.what();
    EXPECT_FALSE(error.parts().expected.empty());
    EXPECT_NE(error.parts().file.find("strokes.json"), std::string::npos);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

// A file whose third stroke, after two good ones, has `fields` beside its path and colour.
std::string third_stroke(const std::string& fields) {
  const std::string good = R"({"color":[1,1,1],"path":[[0,0,0]]})";
  return R"({"strokes":[)" + good + "," + good + R"(,{"color":[1,1,1],"path":[[0,0,0]],)" + fields + "}]}";
}

// A file with one stroke of these fields alone.
std::string only_stroke(const std::string& fields) { return R"({"strokes":[{)" + fields + "}]}"; }

TEST(StrokesFile, FieldsOfAStrokeThatAreWrongAreNamed) {
  const std::string array_of_arrays(2000, '[');
  const ErrorCase cases[] = {
      {third_stroke(R"("mode":"smudge")"), "strokes[2].mode", "\"smudge\""},
      {third_stroke(R"("mode":3)"), "strokes[2].mode", "is 3"},
      {third_stroke(R"("falloff":"linear")"), "strokes[2].falloff", "\"linear\""},
      {third_stroke(R"("radius":-0.3)"), "strokes[2].radius", "is -0.3"},
      {third_stroke(R"("radius":0)"), "strokes[2].radius", "is 0"},
      {third_stroke(R"("radius":1e-60)"), "strokes[2].radius", "is 1e-60"},
      {third_stroke(R"("radius":1e39)"), "strokes[2].radius", "is 1e+39"},
      {third_stroke(R"("radius":"wide")"), "strokes[2].radius", "\"wide\""},
      {third_stroke(R"("radius":null)"), "strokes[2].radius", "null"},
      {third_stroke(R"("opacity":1.5)"), "strokes[2].opacity", "is 1.5"},
      {third_stroke(R"("opacity":-0.5)"), "strokes[2].opacity", "is -0.5"},
      {third_stroke(R"("weight":-1)"), "strokes[2].weight", "is -1"},
      {third_stroke(R"("facing":1)"), "strokes[2].facing", "is 1"},
      {third_stroke(R"("distance":"far")"), "strokes[2].distance", "\"far\""},
      {third_stroke(R"("mirror":"w")"), "strokes[2].mirror", "\"w\""},
      {third_stroke(R"("mirror":true)"), "strokes[2].mirror", "is true"},
      {third_stroke(R"("mirror":{"point":[0,0,0]})"), "strokes[2].mirror", "no \"normal\""},
      {third_stroke(R"("mirror":{"normal":[0,0,0]})"), "strokes[2].mirror.normal", "is [0, 0, 0]"},
      {third_stroke(R"("mirror":{"normal":[0,1]})"), "strokes[2].mirror.normal", "array with 2"},
      {third_stroke(R"("mirror":{"normal":[0,1,0],"axis":"x"})"), "strokes[2].mirror", "unknown key \"axis\""},
      {third_stroke(R"("colour":[1,1,1])"), "strokes[2]", "unknown key \"colour\""},
      {third_stroke(R"("a\nb":1)"), "strokes[2]", R"(unknown key "a\nb")"},
      {only_stroke(R"("path":[[0,0,0]])"), "strokes[0]", "no \"color\""},
      {only_stroke(R"("color":[1,1,1])"), "strokes[0]", "no \"path\""},
      {only_stroke(R"("color":[1,-1,1],"path":[[0,0,0]])"), "strokes[0].color[1]", "is -1"},
      {only_stroke(R"("color":[1,1,1e25],"path":[[0,0,0]])"), "strokes[0].color[2]", "is 1e+25"},
      {only_stroke(R"("color":[1,1],"path":[[0,0,0]])"), "strokes[0].color", "array with 2"},
      {only_stroke(R"("color":1,"path":[[0,0,0]])"), "strokes[0].color", "is 1"},
      {only_stroke(R"("color":[1,1,1],"path":[])"), "strokes[0].path", "array with 0"},
      {only_stroke(R"("color":[1,1,1],"path":[0,0,0])"), "strokes[0].path[0]", "is 0"},
      {only_stroke(R"("color":[1,1,1],"path":[[0,0,0],[0,1]])"), "strokes[0].path[1]", "array with 2"},
      {only_stroke(R"("color":[1,1,1],"path":[[0,0,0],[0,"x",0]])"), "strokes[0].path[1][1]", "\"x\""},
      {only_stroke(R"("color":[1,1,1],"path":[[0,0,-1e300]])"), "strokes[0].path[0][2]", "is -1e+300"},
      {only_stroke(R"("color":[1,1,1],"path":)" + array_of_arrays + std::string(2000, ']')), "strokes[0].path[0]",
       "array with 1"},
  };
  for (const ErrorCase& expected : cases) expect_error(expected);
}

TEST(StrokesFile, FilesThatAreNoStrokeFilesAreErrors) {
  const ErrorCase cases[] = {
      {"", "", "parse error"},
      {"{\"strokes\":[", "", "parse error"},
      {"{\"strokes\":[{\"radius\":NaN}]}", "", "parse error"},
      {"{\"strokes\":[{\"radius\":1e400}]}", "", "1e400"},
      {"\xff\xfe", "", "parse error"},
      {"[]", "", "array with 0"},
      {"{}", "", "no \"strokes\""},
      {R"({"strokes":{}})", "strokes", "object with 0"},
      {R"({"strokes":[7]})", "strokes[0]", "is 7"},
      {R"({"strokes":[],"base":"white"})", "base", "\"white\""},
      {R"({"strokes":[],"bass":"black"})", "", "unknown key \"bass\""},
      {R"({"strokes":")" + std::string(5000, 'x') + "\"}", "strokes", "a string of"},
  };
  for (const ErrorCase& expected : cases) expect_error(expected);
}

TEST(StrokesFile, AMissingFileIsAnError) {
  const TemporaryFolder folder;
  EXPECT_THROW(load_strokes(folder.path() / "none.json"), renderer::Error);
  EXPECT_THROW(load_strokes(folder.path()), renderer::Error);
}

}  // namespace
}  // namespace chiaro::inverse

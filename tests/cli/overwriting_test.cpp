// No output takes the place of an input, of a file that an input refers to, or of another output, whatever the command.

#include <sstream>

#include <gtest/gtest.h>

#include "renderer/core/atomic_file.h"
#include "tests/cli/run_with.h"
#include "tests/support/working_folder.h"

namespace chiaro::cli {
namespace {

namespace fs = std::filesystem;
using tests::Outcome;
using tests::run_with;

const std::string kScenes = std::string(CHIARO_SOURCE_DIR) + "/scenes/";

struct Overwriting {
  const char* kept;     // a file, of which …
  const char* command;  // … this would make another
};

// Refused before they are read, inputs need be no more than there. s.glb is a scene.
class CliOverwriting : public testing::Test {
 protected:
  CliOverwriting() {
    fs::copy_file(kScenes + "cornell.glb", "s.glb");
    for (const char* folder : {"results/frames", "results/pictures", "report"}) fs::create_directories(folder);
  }

  static Outcome run(const std::string& command) {
    std::istringstream words(command);
    return run_with({std::istream_iterator<std::string>(words), {}});
  }

  // The words of a refusal, which leaves the file alone.
  std::string refusal(const Overwriting& over) const {
    if (!fs::exists(over.kept)) folder_.write(over.kept, over.kept);
    const std::string before = renderer::read_file(over.kept);
    const Outcome outcome = run(over.command);
    EXPECT_EQ(outcome.exit_code, kFailed) << over.command << ": " << outcome.standard_error;
    EXPECT_EQ(renderer::read_file(over.kept), before) << over.command;
    return outcome.standard_error;
  }
  void expect_kept(const Overwriting& over) const {
    const std::string words = refusal(over);
    EXPECT_NE(words.find(" of this command"), std::string::npos) << over.command << ": " << words;
  }

  test::WorkingFolder folder_;
};

TEST_F(CliOverwriting, EveryOptionThatNamesAnInputKeepsIt) {
  folder_.write("limits.json", R"({"max_lights":1})");
  for (const Overwriting& over : {
           Overwriting{"s.glb", "receivers s.glb -o s.glb"},
           {"s.glb", "illuminate s.glb -o s.glb"},
           {"t.glb", "illuminate s.glb --on t.glb -o t.glb"},
           {"x.glb", "illuminate s.glb --lights x.glb -o x.glb"},
           {"x.glb", "illuminate s.glb --environment x.glb -o x.glb"},
           {"s.glb", "paint s.glb --strokes x.json -o s.glb"},
           {"x.glb", "paint s.glb --strokes x.glb -o x.glb"},
           {"t.glb", "paint s.glb --strokes x.json --on t.glb -o t.glb"},
           {"t.glb", "paint s.glb --strokes x.json --from t.glb -o t.glb"},
           {"e.exr", "paint s.glb --strokes x.json --environment e.exr --picture e.exr -o out.glb"},
           {"e.exr", "bake s.glb --environment e.exr -o e.exr"},
           {"x.exr", "bake s.glb --on x.exr -o x.exr"},
           {"p.exr", "merge e.exr p.exr -o p.exr"},
           {"e.png", "render s.glb --environment e.png -o e.exr --preview"},
           {"x.exr", "render s.glb --lights x.exr -o x.exr"},
           {"x.exr", "render s.glb --ocio x.exr -o x.exr"},
           {"m.png", "compare m.png e.png -o m.png"},
           {"m.png", "compare e.png m.png -o m.png"},
           {"s.glb", "solve s.glb --target t.glb -o s.glb"},
           {"t.glb", "solve s.glb --target t.glb -o t.glb"},
           {"x.json", "solve s.glb --target t.glb --from x.json -o x.glb"},
           {"limits.json", "solve s.glb --target t.glb --constraints limits.json -o limits.glb"},
           {"x.glb", "solve s.glb --target t.glb --cache x.glb --save-target x.glb -o out.glb"},
           {"x.json", "solve s.glb --target t.glb --ocio x.json -o x.glb"},
           {"x.glb", "solve s.glb --target-image front=x.glb -o x.glb"},
           {"x.glb", "solve s.glb --target-image x.glb -o x.glb"},
           {"x.json", "solve s.glb --target-image a=t.glb --mask a=x.json -o x.glb"},
           {"x.glb", "solve s.glb --target-lightmap floor=x.glb -o x.glb"},
       }) {
    expect_kept(over);
  }
}

TEST_F(CliOverwriting, FoldersOfResultsKeepInputs) {
  expect_kept({"report/target.glb", "solve s.glb --target report/target.glb --report report -o out.glb"});
  expect_kept({"report/target.glb", "solve s.glb --target t.glb --report report -o report/target.glb"});
  for (const std::string file : {"frames/front.exr", "frames/front.png", "pictures/front.found.png", "target.glb"}) {
    const std::string kept = "results/" + file;
    const std::string command =
        "run s.glb -o results --target-image " + kept + " --ocio " + kScenes + "color/config.ocio";
    expect_kept({kept.c_str(), command.c_str()});
  }
}

// It is read and left as it is.
TEST_F(CliOverwriting, ARunTakesTheTargetOfAnEarlierOne) {
  const std::string command =
      "run s.glb -o results --target results/target.glb --ocio " + kScenes + "color/config.ocio";
  const std::string words = refusal({"results/target.glb", command.c_str()});
  EXPECT_NE(words.find("is not a glTF file"), std::string::npos) << words;
}

TEST_F(CliOverwriting, FilesThatInputsReferToAreKept) {
  folder_.write("x.gltf", R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "data:,"}, {"uri": "./b%75f.glb"}],
    "images": [{"name": "image", "uri": "tex.exr"}, {"uri": "sub.json"}]})");
  for (const Overwriting& over : {
           Overwriting{"buf.glb", "receivers x.gltf -o buf.glb"},
           {"buf.glb", "illuminate x.gltf -o buf.glb"},
           {"buf.glb", "paint x.gltf --strokes x.json -o buf.glb"},
           {"buf.glb", "solve s.glb --target x.gltf -o buf.glb"},
           {"sub.json", "solve x.gltf --target t.glb -o sub.glb"},
           {"tex.exr", "bake s.glb --on x.gltf -o tex.exr"},
       }) {
    expect_kept(over);
  }
  folder_.write("lights.json", R"({"lights": [{"type": "environment", "image": "sky.exr"}]})");
  EXPECT_EQ(refusal({"sky.exr", "render s.glb --lights lights.json -o sky.exr"}),
            "chiaro: error: sky.exr: is an input of this command: lights.json refers to it (expected another name for "
            "the output)\n");
}

}  // namespace
}  // namespace chiaro::cli

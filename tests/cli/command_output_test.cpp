// What commands print, and under which names.

#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "inverse/target/target.h"
#include "renderer/core/atomic_file.h"
#include "renderer/image/image_file.h"
#include "renderer/trace/cryptomatte.h"
#include "tests/cli/run_with.h"
#include "tests/inverse/target/foreign_mesh.h"
#include "tests/renderer/io/gltf_builder.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::cli {
namespace {

using inverse::tests::ForeignNode;
using inverse::tests::write_foreign_mesh;
using nlohmann::json;
using test::TemporaryFolder;
using tests::Outcome;
using tests::run_with;

const std::string kScenes = std::string(CHIARO_SOURCE_DIR) + "/scenes/";

Outcome render_preview(const TemporaryFolder& folder, const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"render",
                                     kScenes + "cornell.glb",
                                     "-o",
                                     folder / "frame.exr",
                                     "--width",
                                     "8",
                                     "--samples",
                                     "1",
                                     "--bounces",
                                     "0",
                                     "--preview",
                                     "--ocio",
                                     kScenes + "color/config.ocio"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_with(arguments);
}

TEST(CliRender, AnExposureMayBeAutomatic) {
  const TemporaryFolder folder;
  const Outcome outcome = render_preview(folder, {"--exposure", "bright"});
  EXPECT_EQ(outcome.exit_code, kWrongUsage);
  EXPECT_NE(outcome.standard_error.find("expected auto, or a number from -100 to 100"), std::string::npos)
      << outcome.standard_error;
}

TEST(CliRender, NamesThePreviewAmongWhatItWrote) {
  const TemporaryFolder folder;
  const std::string frame = folder / "frame.exr", preview = folder / "frame.png";
  const Outcome text = render_preview(folder, {});
  ASSERT_EQ(text.exit_code, kDone) << text.standard_error;
  EXPECT_NE(text.standard_output.find(frame + ", " + preview), std::string::npos) << text.standard_output;
  const json summary = json::parse(render_preview(folder, {"--json"}).standard_output);
  EXPECT_EQ(summary["written"], json::array({frame, preview}));
  for (const std::string file : summary["written"]) EXPECT_TRUE(std::filesystem::exists(file)) << file;
}

const std::string* text_of(const renderer::Attributes& attributes, const std::string& name) {
  for (const auto& [key, value] : attributes) {
    if (key == name) return std::get_if<std::string>(&value);
  }
  return nullptr;
}

// Of a frame under a lamp this bright, but neither with --float nor under the scene's own.
void expect_said_of_halves(const std::string& candela, const std::string& text) {
  const TemporaryFolder folder;
  const std::string intensity = candela + "," + candela + "," + candela;
  const std::string lights =
      folder.write("lights.json", R"({"lights":[{"position":[0,1,0],"intensity":[)" + intensity + "]}]}").string();
  const Outcome halves = render_preview(folder, {"--lights", lights});
  EXPECT_NE(halves.standard_error.find(text), std::string::npos) << halves.standard_error;
  EXPECT_EQ(render_preview(folder, {"--lights", lights, "--float"}).standard_error.find(text), std::string::npos);
  EXPECT_EQ(render_preview(folder, {}).standard_error.find(text), std::string::npos);
}

TEST(CliRender, SaysHowManyPixelsHalvesDoNotHold) {
  expect_said_of_halves("1e10", " pixels are brighter than half floats hold");
}

TEST(CliRender, SaysThatAFrameIsTooDimForHalves) { expect_said_of_halves("1e-6", "is too dim for half floats"); }

TEST(CliRender, NoiseOfOneSampleIsNotKnown) {
  const TemporaryFolder folder;
  EXPECT_NE(render_preview(folder, {}).standard_output.find("not known"), std::string::npos);
  const json summary = json::parse(render_preview(folder, {"--json"}).standard_output);
  EXPECT_TRUE(summary.at("relative_standard_error").is_null());
  for (const auto& [name, value] : renderer::load_image_header(folder / "frame.exr").attributes) {
    EXPECT_NE(name, "chiaro:relative_standard_error");
  }
}

std::string white_sky(const TemporaryFolder& folder) {
  renderer::Image sky = renderer::make_image(2, 1, {"R", "G", "B"});
  sky.pixels.assign(sky.pixels.size(), 1);
  renderer::save_image(sky, folder / "sky.exr", renderer::PixelType::kHalf);
  return folder / "sky.exr";
}

TEST(CliRender, HeadersNameFilesAndLimits) {
  const TemporaryFolder folder;
  const std::string lights =
      folder.write("lights.json", R"({"lights":[{"position":[0,1,0],"intensity":[1,1,1]}]})").string();
  const Outcome outcome =
      render_preview(folder, {"--lights", lights, "--environment", white_sky(folder), "--time", "900"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.standard_error;
  const renderer::Attributes attributes = renderer::load_image_header(folder / "frame.exr").attributes;
  ASSERT_NE(text_of(attributes, "chiaro:lights"), nullptr);
  EXPECT_EQ(*text_of(attributes, "chiaro:lights"), "lights.json");
  ASSERT_NE(text_of(attributes, "chiaro:environment"), nullptr);
  EXPECT_EQ(*text_of(attributes, "chiaro:environment"), "sky.exr");
  const auto limit = std::find_if(attributes.begin(), attributes.end(),
                                  [](const auto& attribute) { return attribute.first == "chiaro:time_limit"; });
  ASSERT_NE(limit, attributes.end());
  EXPECT_EQ(std::get<float>(limit->second), 900);
}

TEST(CliPaint, PicturesAreAsBrightAsTheIllumination) {
  const TemporaryFolder folder;
  const std::string strokes =
      folder
          .write("s.json",
                 R"({"base":"black","strokes":[{"mode":"add","color":[1e6,1e6,1e6],"radius":9,"path":[[0,0,0]]}]})")
          .string();
  const std::string picture = folder / "picture.exr";
  const Outcome painted = run_with({"paint", kScenes + "cornell.glb", "--strokes", strokes, "--max-edge", "0.5",
                                    "--picture", picture, "--width", "16", "-o", folder / "painted.glb"});
  ASSERT_EQ(painted.exit_code, kDone) << painted.standard_error;
  const renderer::Image image = renderer::load_image(picture).image;
  EXPECT_GT(*std::max_element(image.pixels.begin(), image.pixels.end()), 9e4F);
}

void expect_told(const Outcome& outcome, const std::string& line, bool told = true) {
  EXPECT_EQ(outcome.standard_error.find("chiaro: warning: " + line + "\n") != std::string::npos, told)
      << line << " in " << outcome.standard_error;
}

TEST(CliPaint, LightThatIsNotTracedIsTold) {
  const TemporaryFolder folder;
  const std::string painted = folder / "painted.glb";
  const std::string strokes =
      folder.write("s.json", R"({"strokes":[{"color":[1,1,1],"radius":9,"path":[[0,0,0]]}]})").string();
  const auto paint = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"paint", kScenes + "cornell.glb", "--strokes", strokes, "-o", painted};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_with(arguments);
  };
  const std::string black = ": does nothing on strokes whose base is black";
  const Outcome on_black = paint({"--samples", "4", "--bounces", "0", "--albedo", "0.5"});
  EXPECT_EQ(on_black.exit_code, kDone) << on_black.standard_error;
  for (const char* option : {"--samples", "--bounces", "--albedo"}) expect_told(on_black, option + black);
  const Outcome pictured = paint({"--albedo", "0.5", "--picture", folder / "p.exr", "--width", "8"});
  expect_told(pictured, "--albedo" + black, false);
  const std::string earlier = folder / "earlier.glb";
  std::filesystem::copy_file(painted, earlier);
  const Outcome again = paint({"--from", earlier, "--samples", "4"});
  expect_told(again, "--samples: does nothing with --from, which has an illumination of its own");
  const Outcome turned = paint({"--environment-rotation", "30"});
  EXPECT_EQ(turned.exit_code, kFailed);
  EXPECT_NE(turned.standard_error.find("there is no environment"), std::string::npos) << turned.standard_error;
}

// On the balls, parts of which hardly face the side that is painted from.
TEST(CliPaint, StrokesOnATargetBeginFromItsWeights) {
  const TemporaryFolder folder;
  const auto paint = [&](const std::string& strokes, const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{
        "paint", kScenes + "fiveballs.glb", "--strokes", folder.write("s.json", strokes).string(), "-o", folder / name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_with(arguments);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.standard_error;
    return inverse::load_target(folder / name).weight;
  };
  const std::string all = R"("radius":20,"distance":"space","facing":false,"falloff":"hard","path":[[0,0,0]])";
  const std::string base = folder / "base.glb";
  paint(R"({"strokes":[{"color":[1,1,1],"weight":0.05,)" + all + "}]}", "base.glb", {"--max-edge", "0.2"});
  const std::string dab =
      R"({"strokes":[{"mode":"set","opacity":0,"color":[0,0,0],"radius":1.2,"path":[[0.55,1.1,-1.35]],"weight":5}]})";
  const std::vector<float> kept = paint(dab, "kept.glb", {"--from", base});
  EXPECT_EQ(kept, paint(dab, "given.glb", {"--from", base, "--unpainted-weight", "0.05"}));
  const auto between = [](float weight) { return weight > 0.05F && weight < 5; };
  EXPECT_TRUE(std::any_of(kept.begin(), kept.end(), between));
  EXPECT_LE(*std::max_element(kept.begin(), kept.end()), 5);
  paint(R"({"strokes":[{"color":[1,1,1],"weight":2e38,)" + all + "}]}", "heavy.glb", {"--from", base});
}

// A square of ground, 2 m wide, with blades that are stuck into it.
std::string lawn() {
  std::mt19937 random(1);
  const auto between = [&](double least, double most) {
    return least + (most - least) * double(random()) / 4294967295.0;
  };
  std::vector<float> positions{-1, 0, -1, 1, 0, -1, 1, 0, 1, -1, 0, 1};
  std::vector<std::uint16_t> indices{0, 2, 1, 0, 3, 2};
  for (std::uint16_t blade = 0; blade < 300; ++blade) {
    const double x = between(-0.98, 0.98), z = between(-0.98, 0.98), angle = between(0, 6.28);
    const double across = 0.02 * std::cos(angle), along = 0.02 * std::sin(angle);
    for (const double v : {x - across, -0.01, z - along, x + across, -0.01, z + along, x, 0.2, z})
      positions.push_back(float(v));
    for (const int corner : {0, 1, 2}) indices.push_back(std::uint16_t(4 + 3 * blade + corner));
  }
  renderer::tests::GltfBuilder gltf;
  gltf.add_node({{"mesh", gltf.add_mesh({{"POSITION", gltf.add_accessor(positions, 3, renderer::tests::kFloat)}})}});
  gltf.primitive()["indices"] = gltf.add_accessor(indices, 1, renderer::tests::kUnsignedShort);
  return gltf.glb();
}

// Between furniture that stands and lies on the floor, and over a lawn of blades that are stuck into the ground: no way
// along surfaces is shorter than the straight line, and the brush is nowhere brighter than straight through the air.
TEST(CliPaint, SurfacesAreNoShortcuts) {
  const TemporaryFolder folder;
  const auto expect_no_shortcut = [&](const std::string& scene, float radius, const std::string& edge) {
    const std::string painted = folder / "painted.glb";
    const auto strokes = folder.write("s.json", fmt::format(R"({{"base":"black","strokes":[
        {{"color":[1,1,1],"radius":{},"path":[[0,0,0]]}}]}})",
                                                            radius));
    const Outcome outcome = run_with({"paint", scene, "--strokes", strokes, "--max-edge", edge, "-o", painted});
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.standard_error;
    const inverse::Target target = inverse::load_target(painted);
    std::size_t lit = 0;
    for (std::size_t i = 0; i < target.receivers.size(); ++i) {
      const float x = std::min(1.0F, length(target.receivers.positions[i]) / radius), smooth = 1 - x * x * (3 - 2 * x);
      lit += target.illumination[i].x > 0 ? 1 : 0;
      ASSERT_LE(target.illumination[i].x, smooth + 0.02F) << scene << ", receiver " << i;
    }
    EXPECT_GT(lit, 100U);
  };
  expect_no_shortcut(kScenes + "bedroom.glb", 1, "0.1");
  expect_no_shortcut(folder.write("lawn.glb", lawn()), 2, "0.05");
}

TEST(CliPaint, BlackTargetsArePaintedOnAndCompared) {
  const TemporaryFolder folder;
  const std::string scene = kScenes + "cornell.glb", black = folder / "black.glb", lit = folder / "lit.glb";
  const auto strokes = [&](const std::string& list) {
    return folder.write("s.json", R"({"base":"black","strokes":[)" + list + "]}").string();
  };
  ASSERT_EQ(run_with({"paint", scene, "--strokes", strokes(""), "--max-edge", "1", "-o", black}).exit_code, kDone);
  const std::string dab = strokes(R"({"color":[1,1,1],"radius":9,"path":[[0,0,0]]})");
  const Outcome painted = run_with({"paint", scene, "--strokes", dab, "--from", black, "-o", lit});
  EXPECT_EQ(painted.exit_code, kDone) << painted.standard_error;
  EXPECT_TRUE(inverse::wants_light(inverse::load_illumination(lit)));
  const Outcome same = run_with({"compare", black, black, "--json"});
  EXPECT_EQ(same.exit_code, kDone) << same.standard_error;
  EXPECT_NE(same.standard_output.find("\"relative_l2\": 0"), std::string::npos) << same.standard_output;
}

TEST(CliPaint, PicturesThatCannotBeAreFoundBeforeThePainting) {
  const TemporaryFolder folder;
  const std::string strokes =
      folder.write("s.json", R"({"strokes":[{"color":[1,1,1],"radius":9,"path":[[0,0,0]]}]})").string();
  const std::string painted = folder / "painted.glb";
  const auto paint = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"paint",     kScenes + "cornell.glb", "--strokes", strokes, "-o", painted,
                                       "--picture", folder / "picture.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_with(arguments).exit_code;
  };
  EXPECT_EQ(paint({"--camera", "nobody"}), kFailed);
  EXPECT_EQ(paint({"--width", "60000", "--height", "60000"}), kWrongUsage);
  EXPECT_FALSE(std::filesystem::exists(painted));
}

TEST(CliSolve, AScaleOfWhatIsNotScaledIsTold) {
  const TemporaryFolder folder;
  const std::string scene = kScenes + "cornell.glb", target = folder / "target.glb";
  const Outcome lit =
      run_with({"illuminate", scene, "-o", target, "--max-edge", "1", "--samples", "4", "--bounces", "0"});
  ASSERT_EQ(lit.exit_code, kDone) << lit.standard_error;
  const Outcome solved = run_with({"solve", scene, "--target", target, "--target-scale", "500", "--keep-white",
                                   "--keep-positions", "--bounces", "0", "-o", folder / "lights.glb"});
  EXPECT_EQ(solved.exit_code, kDone) << solved.standard_error;
  expect_told(solved, "--target-scale: does nothing with " + target + ", whose _ILLUMINATION is in cd/m²");
  expect_told(solved, "--keep-white: does nothing without --target-image or --target-lightmap");
}

// Of three triangles one above the other the first lies on the floor.
TEST(CliIlluminate, ReceiversOffTheSurfacesAreTold) {
  const TemporaryFolder folder;
  const std::string receivers = write_foreign_mesh(folder, {{"floor", {}}, {"shelf", {}}}).string();
  const Outcome told = run_with({"illuminate", kScenes + "cornell.glb", "--on", receivers, "-o", folder / "lit.glb",
                                 "--samples", "1", "--bounces", "0"});
  EXPECT_EQ(told.exit_code, kDone) << told.standard_error;
  expect_told(told, receivers + ": 50 % of the vertices lie on no surface of " + kScenes +
                        "cornell.glb: was the scene changed since?");
}

TEST(CliCompare, VertexColoursMayBeScaled) {
  const TemporaryFolder colours, candela;
  const std::string dim = write_foreign_mesh(colours, {{"a", {{"COLOR_0", std::vector<float>(9, 1)}}}}).string();
  const std::string bright =
      write_foreign_mesh(candela, {{"a", {{"_ILLUMINATION", std::vector<float>(9, 5)}}}}).string();
  const auto error = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"compare", dim, bright, "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return json::parse(run_with(arguments).standard_output).at("relative_l2").get<double>();
  };
  EXPECT_NEAR(error({}), 0.8, 1e-6);
  EXPECT_NEAR(error({"--target-scale", "5"}), 0, 1e-6);
  expect_told(run_with({"compare", bright, bright, "--target-scale", "5"}),
              "--target-scale: does nothing with _ILLUMINATION, which is in cd/m²");
}

TEST(CliProgram, NamesTheWordThatIsNoCommand) {
  const Outcome outcome = run_with({"slove", "room.glb"});
  EXPECT_EQ(outcome.exit_code, kWrongUsage);
  EXPECT_NE(outcome.standard_error.find("'slove' is no command (expected one of: "), std::string::npos)
      << outcome.standard_error;
}

// Caches of the box, with receivers of their own.
struct Baked {
  Outcome outcome;
  std::string file;
};

Baked bake(const TemporaryFolder& folder, const std::string& name, const std::vector<std::string>& more) {
  const std::string file = folder / name;
  std::vector<std::string> arguments{
      "bake", kScenes + "cornell.glb", "-o", file, "--grid", "2,2,2", "--samples", "1", "--bounces", "0"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return {run_with(arguments), file};
}

TEST(CliBake, AnEnvironmentIsToldToDoNothing) {
  const TemporaryFolder folder;
  const Outcome baked = bake(folder, "cache.exr", {"--max-edge", "1", "--environment", white_sky(folder)}).outcome;
  EXPECT_EQ(baked.exit_code, kDone) << baked.standard_error;
  expect_told(baked, "--environment: does nothing in a bake, which is the same under any environment");
}

TEST(CliBake, MaterialsThatAnAlbedoReplacesAreToldToDoNothing) {
  const TemporaryFolder folder;
  const std::string told = "--materials gltf: does nothing with --albedo";
  const auto outcome = [&](const std::string& model) {
    return bake(folder, "cache.exr", {"--max-edge", "1", "--materials", model, "--albedo", "0.5"}).outcome;
  };
  expect_told(outcome("gltf"), told);
  EXPECT_EQ(outcome("diffuse").standard_error.find(told), std::string::npos);
}

TEST(CliRender, ABoundOnBouncesIsToldToDoNothingWhereThereAreNone) {
  const TemporaryFolder folder;
  const std::string told = "--clamp-indirect: does nothing with --bounces 0";
  const auto outcome = [&](const std::string& bounces) {
    return run_with({"render", kScenes + "cornell.glb", "-o", folder / "frame.exr", "--width", "8", "--samples", "1",
                     "--bounces", bounces, "--clamp-indirect", "9"});
  };
  expect_told(outcome("0"), told);
  EXPECT_EQ(outcome("1").standard_error.find(told), std::string::npos);
}

TEST(CliSolve, OptionsThatACacheOrATargetFileLeavesIdleAreTold) {
  const TemporaryFolder folder;
  const std::string scene = kScenes + "cornell.glb", target = folder / "target.glb";
  run_with({"illuminate", scene, "-o", target, "--max-edge", "1", "--samples", "4", "--bounces", "0"});
  const Baked cache = bake(folder, "cache.exr", {"--on", target});
  ASSERT_EQ(cache.outcome.exit_code, kDone) << cache.outcome.standard_error;
  const Outcome solved = run_with({"solve", scene, "--target", target, "--cache", cache.file, "--samples", "9",
                                   "--hide-backs", "--keep-positions", "-o", folder / "lights.glb"});
  EXPECT_EQ(solved.exit_code, kDone) << solved.standard_error;
  expect_told(solved, "--samples: does nothing with --cache, which was baked with its own");
  expect_told(solved, "--hide-backs: does nothing without --target-image");
}

TEST(CliCompare, SaysWhichKindsOfFilesItIsGiven) {
  const TemporaryFolder folder;
  const std::string cache = bake(folder, "cache.exr", {"--max-edge", "1"}).file;
  const std::string frame = folder / "frame.exr", scene = kScenes + "cornell.glb";
  renderer::save_image(renderer::make_image(2, 1, {"R", "G", "B"}), frame, renderer::PixelType::kHalf);
  for (const auto& [file, kind] : {std::pair{cache, "a transport cache"}, {frame, "a frame"}}) {
    const Outcome outcome = run_with({"compare", scene, file});
    EXPECT_EQ(outcome.exit_code, kFailed);
    EXPECT_NE(outcome.standard_error.find(file + " is " + kind), std::string::npos) << outcome.standard_error;
  }
}

TEST(CliInspect, PartsOfCachesSayWhichOfHowMany) {
  const TemporaryFolder folder;
  const json whole = json::parse(
      run_with({"inspect", bake(folder, "whole.exr", {"--max-edge", "0.2"}).file, "--json"}).standard_output);
  EXPECT_EQ(whole["kind"], "transport cache");
  const Baked part = bake(folder, "part.exr", {"--max-edge", "0.2", "--shard", "2/2"});
  ASSERT_EQ(part.outcome.exit_code, kDone) << part.outcome.standard_error;
  const Outcome inspected = run_with({"inspect", part.file, "--json"});
  ASSERT_EQ(inspected.exit_code, kDone) << inspected.standard_error;
  const json found = json::parse(inspected.standard_output);
  EXPECT_EQ(found["kind"], "part of a transport cache");
  EXPECT_EQ(found["receivers"], whole["receivers"]);
  EXPECT_EQ(found["lights"], whole["lights"]);
  EXPECT_GT(found["part"]["first_receiver"], 0);
  EXPECT_EQ(found["part"]["last_receiver"], int(whole["receivers"]) - 1);
  const std::string bytes = renderer::read_file(part.file);
  const auto cut = folder.write("cut.exr", bytes.substr(0, bytes.size() - 100));
  EXPECT_EQ(run_with({"inspect", cut.string()}).exit_code, kFailed);
}

TEST(CliIlluminate, OnePathWritesNoStandardErrors) {
  const TemporaryFolder folder;
  const std::string file = folder / "lit.glb";
  const Outcome outcome =
      run_with({"illuminate", kScenes + "cornell.glb", "-o", file, "--max-edge", "0.5", "--samples", "1", "--json"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.standard_error;
  EXPECT_TRUE(json::parse(outcome.standard_output).at("relative_standard_error").is_null());
  EXPECT_TRUE(inverse::load_target(file).standard_error.empty());
}

TEST(CliRender, MattesHaveTheirManifest) {
  const TemporaryFolder folder;
  const Outcome outcome = render_preview(folder, {"--layers", "cryptomatte"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.standard_error;
  const renderer::Attributes attributes = renderer::load_image_header(folder / "frame.exr").attributes;
  for (const std::string layer : {"CryptoObject", "CryptoMaterial"}) {
    const std::string prefix =
        "cryptomatte/" + fmt::format("{:08x}", renderer::murmur_hash_3_32(layer)).substr(0, 7) + "/";
    ASSERT_NE(text_of(attributes, prefix + "name"), nullptr);
    EXPECT_EQ(*text_of(attributes, prefix + "name"), layer);
    EXPECT_EQ(*text_of(attributes, prefix + "hash"), "MurmurHash3_32");
    EXPECT_EQ(*text_of(attributes, prefix + "conversion"), "uint32_to_float32");
    const json manifest = json::parse(*text_of(attributes, prefix + "manifest"));
    EXPECT_GT(manifest.size(), 2U);
    for (const auto& [name, id] : manifest.items()) EXPECT_EQ(id, fmt::format("{:08x}", renderer::matte_id(name)));
  }
}

TEST(CliRender, LensesAreWrittenIntoTheHeaderAndNeedAnFNumber) {
  const TemporaryFolder folder;
  const std::vector<std::string> camera{"--f-number", "2",  "--focus-distance", "3.5", "--shutter", "0.02",
                                        "--iso",      "400"};
  ASSERT_EQ(render_preview(folder, camera).exit_code, kDone);
  const renderer::Attributes attributes = renderer::load_image_header(folder / "frame.exr").attributes;
  for (const auto& [name, expected] :
       {std::pair{"aperture", 2.0F}, {"focus", 3.5F}, {"expTime", 0.02F}, {"isoSpeed", 400.0F}}) {
    bool found = false;
    for (const auto& [key, value] : attributes) found = found || (key == name && std::get<float>(value) == expected);
    EXPECT_TRUE(found) << name;
  }
  EXPECT_EQ(render_preview(folder, {"--focus-distance", "3.5"}).exit_code, kWrongUsage);
  EXPECT_EQ(render_preview(folder, {"--shutter", "0.1"}).exit_code, kWrongUsage);
  EXPECT_EQ(render_preview(folder, {"--f-number", "2", "--shutter", "0.1", "--exposure", "auto"}).exit_code,
            kWrongUsage);
}

TEST(CliRender, ShuttersThatExposeNothingAreTold) {
  const TemporaryFolder folder;
  const std::string line = "--shutter: exposes nothing without --preview";
  const Outcome alone = run_with({"render", kScenes + "cornell.glb", "-o", folder / "frame.exr", "--width", "4",
                                  "--samples", "1", "--f-number", "2", "--shutter", "0.02"});
  EXPECT_EQ(alone.exit_code, kDone) << alone.standard_error;
  expect_told(alone, line);
  expect_told(render_preview(folder, {"--f-number", "2", "--shutter", "0.02"}), line, false);
}

std::string grey_frame(const TemporaryFolder& folder, const std::string& name, float grey) {
  renderer::Image image = renderer::make_image(4, 4, {"R", "G", "B"});
  image.pixels.assign(image.pixels.size(), grey);
  renderer::save_image(image, folder / name, renderer::PixelType::kHalf);
  return folder / name;
}

TEST(CliCompare, QuietPrintsNothingButTheSummaryOfJson) {
  const TemporaryFolder folder;
  const std::string a = grey_frame(folder, "a.exr", 1), b = grey_frame(folder, "b.exr", 2);
  const Outcome quiet = run_with({"compare", a, b, "--quiet"});
  EXPECT_EQ(quiet.exit_code, kDone);
  EXPECT_EQ(quiet.standard_output + quiet.standard_error, "");
  const Outcome as_json = run_with({"compare", a, b, "--quiet", "--json"});
  EXPECT_EQ(json::parse(as_json.standard_output)["relative_l2"], 0.5);
  EXPECT_EQ(run_with({"compare", a, b, "--quiet", "--fail-above", "0.1"}).exit_code, kLimitExceeded);
  EXPECT_NE(run_with({"compare", a, b}).standard_output, "");
}

TEST(CliInspect, LightsMayBeCalledStrokes) {
  const TemporaryFolder folder;
  const auto file = folder.write(
      "lights.json", R"({"lights":[{"name":"strokes","type":"point","position":[0,1,0],"intensity":[1,1,1]}]})");
  const Outcome outcome = run_with({"inspect", file.string()});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.standard_error;
}

TEST(CliInspect, QuietSaysByItsExitAloneWhetherAFileIsGood) {
  const Outcome good = run_with({"inspect", kScenes + "cornell.glb", "--quiet"});
  EXPECT_EQ(good.exit_code, kDone);
  EXPECT_EQ(good.standard_output + good.standard_error, "");
}

// ESC, BEL, a line end and a control character of two bytes.
const std::string kUnruly =
    "a\x1b[31m\a\nb\xc2\x9b"
    "1m";

bool holds_controls(const std::string& text) { return text.find_first_of("\x1b\a\x9b") != std::string::npos; }

TEST(CliReceivers, ItsNameCannotSpeakToTheTerminal) {
  const TemporaryFolder folder;
  const Outcome outcome = run_with({"receivers", kScenes + "cornell.glb", "-o", folder / (kUnruly + ".glb")});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.standard_error;
  EXPECT_FALSE(holds_controls(outcome.standard_output)) << outcome.standard_output;
  EXPECT_EQ(std::count(outcome.standard_output.begin(), outcome.standard_output.end(), '\n'), 1);
}

TEST(CliCompare, NamesOfALimitCannotSpeakToTheTerminal) {
  const TemporaryFolder folder;
  const std::string a = grey_frame(folder, kUnruly + ".exr", 1), b = grey_frame(folder, "b.exr", 2);
  for (const std::string region : {"", "x=0,0,4,4", "\x1b[2J\n=0,0,4,4"}) {
    std::vector<std::string> arguments{"compare", a, b, "--quiet", "--fail-above", "0.1"};
    if (!region.empty()) arguments.insert(arguments.end(), {"--crop", region});
    const Outcome outcome = run_with(arguments);
    ASSERT_EQ(outcome.exit_code, kLimitExceeded) << outcome.standard_error;
    EXPECT_FALSE(holds_controls(outcome.standard_error)) << outcome.standard_error;
    EXPECT_EQ(std::count(outcome.standard_error.begin(), outcome.standard_error.end(), '\n'), 1);
  }
}

TEST(CliRender, NamesThatAreNotFoundCannotSpeakToTheTerminal) {
  const TemporaryFolder folder;
  const Outcome outcome = render_preview(folder, {"--camera", kUnruly});
  EXPECT_EQ(outcome.exit_code, kFailed);
  EXPECT_FALSE(holds_controls(outcome.standard_error)) << outcome.standard_error;
}

const ForeignNode kColoured{"floor", {{"COLOR_0", {0.5F, 0, 0, 0.5F, 0, 0, 0.5F, 0.75F, 0}}}};

json inspected(const std::filesystem::path& file) {
  return json::parse(run_with({"inspect", file, "--json"}).standard_output);
}

TEST(CliInspect, BareSurfacesWithColoursAreATarget) {
  const TemporaryFolder folder;
  const json found = inspected(write_foreign_mesh(folder, {kColoured, {"unpainted", {}}}));
  EXPECT_EQ(found["kind"], "target");
  EXPECT_EQ(found["attribute"], "COLOR_0");
  EXPECT_EQ(found["receivers"], 6);
  EXPECT_EQ(found["mean_illumination"], json::array({0.5, 0.25, 0.0}));
  EXPECT_EQ(found["max_illumination"], json::array({0.5, 0.75, 0.0}));
  EXPECT_EQ(found["weight"], json({{"min", 0.0}, {"max", 1.0}, {"zero", 3}}));
}

TEST(CliInspect, ValuesInCandelaComeBeforeColours) {
  const TemporaryFolder folder;
  ForeignNode node = kColoured;
  node.attributes.emplace_back("_ILLUMINATION", std::vector<float>(9, 7));
  const json found = inspected(write_foreign_mesh(folder, {node}));
  EXPECT_EQ(found["attribute"], "_ILLUMINATION");
  EXPECT_EQ(found["mean_illumination"], json::array({7.0, 7.0, 7.0}));
}

TEST(CliInspect, WhatATargetLosesInReadingIsTold) {
  const TemporaryFolder folder;
  json gltf = json::parse(renderer::read_file(write_foreign_mesh(folder, {kColoured})));
  gltf["extensionsUsed"] = {"EXT_of_nobody"};
  const std::string file = folder.write("target.gltf", gltf.dump()).string();
  const std::string lost = file + ": extension EXT_of_nobody is not read; what it changes is left out";
  EXPECT_EQ(inspected(file)["warnings"], json::array({lost}));
  const std::string strokes =
      folder.write("s.json", R"({"strokes":[{"color":[1,1,1],"radius":9,"path":[[0,0,0]]}]})").string();
  for (const char* option : {"--on", "--from"}) {
    const Outcome painted = run_with({"paint", file, "--strokes", strokes, option, file, "-o", folder / "painted.glb"});
    EXPECT_EQ(painted.exit_code, kDone) << painted.standard_error;
    expect_told(painted, lost);
  }
}

TEST(CliInspect, OptionsOfScenesThatDoNothingAreTold) {
  const Outcome outcome = run_with({"inspect", kScenes + "lights/fiveballs-3.json", "--variant", "red", "--json"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.standard_error;
  EXPECT_EQ(json::parse(outcome.standard_output)["warnings"],
            json::array({"--variant: does nothing with a file that is not a scene"}));
}

TEST(CliInspect, ColouredSurfacesWithMaterialsAreAScene) {
  const TemporaryFolder folder;
  const std::filesystem::path file = write_foreign_mesh(folder, {kColoured});
  json gltf = json::parse(renderer::read_file(file));
  gltf["materials"] = json::array({{{"name", "wood"}}});
  EXPECT_EQ(inspected(folder.write("scene.gltf", gltf.dump()))["kind"], "scene");
}

}  // namespace
}  // namespace chiaro::cli

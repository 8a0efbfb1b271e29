// The page of a report: it needs nothing but itself, and no name in a scene can become a part of it.

#include "inverse/solve/report_page.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "inverse/solve/embedded_file.h"
#include "inverse/solve/report_data.h"

namespace chiaro::inverse {
namespace {

using nlohmann::json;

const char* const kNasty = "</script><script>alert(1)</script><!-- \"'& \xff.glb";

// One triangle under one light.
struct SmallSolve {
  renderer::Scene scene;
  Target target;
  SolveStages stages{.importance = {{0.5, 0, 1}, {0, 1, 0.5}, {0.5, 1, 1.5}, {1, 2}, {1, 1}},
                     .grid = {},
                     .distribution = {},
                     .clusters = {{{0.5, 1, 0.5}, {3, 2, 1}}},
                     .tree = {{{{}}, 1}, {{{0.5, 1, 0.5}, {3, 2, 1}}}, {}},
                     .cut = {0},
                     .found = {{{0.5, 1, 0.5}, {3, 2, 1}}}};
  SolveResult result;

  SmallSolve() {
    scene.path = std::string("/somewhere/") + kNasty;
    scene.cameras.emplace_back().name = kNasty;
    target.receivers.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 2}};
    target.receivers.triangles = {{0, 2, 1}};
    target.illumination = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
    target.weight = {1, 1, 0.5F};
    result.illumination = target.illumination;
    const renderer::PointLight light{"light1", {0.5F, 1, 0.5F}, {3, 2, 1}};
    result.lights = {{light, 1, {0.1F, renderer::kInfinity, 0.1F}, {1, 1, 1}}};
    result.error_curve = {{{light}, 0.25}};
    result.stages = {{"polish", 1.5, {{"relative_l2", 0.125}}}};
  }

  SolveTrace trace() const { return {scene, target, stages, result}; }
};

std::size_t count_of(std::string_view part, std::string_view text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

std::string data_of(const std::string& page) {
  const std::string begin = "id=\"data\">";
  const std::size_t at = page.find(begin) + begin.size();
  return page.substr(at, page.find("</script>", at) - at);
}

TEST(ReportPage, AsksNothingOfAnybody) {
  const std::string page = make_report_page("{}");
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
  for (const char* loads : {"<link", "<img", "<iframe", "<script src", "@import", "<base", "http-equiv=\"refresh"}) {
    EXPECT_EQ(count_of(loads, page), 0U) << loads;
  }
  for (const char* file : {"page.html", "page.css", "decode.js", "format.js", "surface.js", "markers.js", "layers.js",
                           "framing.js", "view.js", "panel.js", "tables.js", "plots.js", "dendrogram.js", "main.js"}) {
    const std::string_view text = embedded_file(file);
    EXPECT_FALSE(text.empty()) << file;
    for (const char* loads : {"http:", "https:", "src=", "href=", "url(", "import(", "import {", "fetch(",
                              "XMLHttpRequest", "innerHTML", "document.write", "eval("}) {
      EXPECT_EQ(count_of(loads, text), 0U) << file << ": " << loads;
    }
  }
}

TEST(ReportPage, HoldsItsScriptsWhole) {
  const std::string page = make_report_page("{}");
  EXPECT_EQ(count_of("<script", page), count_of("</script>", page));
  EXPECT_EQ(count_of("{{", embedded_file("page.html")), count_of("<script", page) + 1);  // and the style
  EXPECT_NE(page.find(embedded_file("three.min.js")), std::string::npos);
  EXPECT_NE(page.find(embedded_file("main.js")), std::string::npos);
  EXPECT_TRUE(page.ends_with("</html>\n"));
}

TEST(ReportPage, NoNameBecomesAPartOfIt) {
  const SmallSolve solve;
  const std::string page = make_report_page(page_json(solve.trace()));
  EXPECT_EQ(count_of("alert(1)</script>", page), 0U);
  EXPECT_EQ(count_of("<script", page), count_of("<script", make_report_page("{}")));
  EXPECT_EQ(page.find("/somewhere/"), std::string::npos);
  const json data = json::parse(data_of(page));
  EXPECT_EQ(data["cameras"][0]["name"], "</script><script>alert(1)</script><!-- \"'& \xef\xbf\xbd.glb");
}

TEST(ReportPage, SaysWhatWasFound) {
  const SmallSolve solve;
  const json data = json::parse(page_json(solve.trace()));
  EXPECT_EQ(data["receivers"]["triangle_count"], 1);
  EXPECT_EQ(data["result"]["lights"][0]["position"], json({0.5, 1, 0.5}));
  EXPECT_TRUE(data["result"]["lights"][0]["interval_90"]["position"][1].is_null());
  EXPECT_EQ(data["result"]["stage_seconds"], json({1.5}));
}

TEST(ReportPage, StagesHoldTheErrorCurveAndFiguresWithoutSeconds) {
  const SmallSolve solve;
  const std::string text = stages_json(solve.trace());
  const json stages = json::parse(text);
  EXPECT_EQ(stages["error_curve"][0]["light_count"], 1);
  EXPECT_EQ(stages["error_curve"][0]["relative_l2"], 0.25);
  EXPECT_EQ(stages["stages"][0]["figures"]["relative_l2"], 0.125);
  EXPECT_EQ(stages["tree"]["cut"], json::array({0}));
  EXPECT_EQ(text.find("seconds"), std::string::npos);
}

}  // namespace
}  // namespace chiaro::inverse

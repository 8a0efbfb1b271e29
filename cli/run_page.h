#pragma once
// The page that `run` leaves: one file to send round, which needs no other file, no network and no script.

#include <string>
#include <vector>

#include "cli/json_output.h"
#include "cli/text_output.h"
#include "inverse/solve/solve.h"
#include "inverse/target/compare_targets.h"

namespace chiaro::cli {

struct PagePicture {
  std::string title, text;
  std::string png;  // its bytes
};

struct PageCamera {
  std::string name;
  std::vector<PagePicture> pictures;
};

struct RunPage {
  std::string scene;   // file name
  std::string wanted;  // what the target was made of, in words
  const inverse::SolveResult& result;
  const inverse::TargetComparison& comparison;
  renderer::Lights kept_lights;
  std::vector<PageCamera> cameras;
  std::vector<TextRow> settings;
  std::string command;
  bool time_limited = false;  // which makes no two runs the same
  JsonObject summary;
};

// Names may hold anything: they are escaped. Says nothing that differs from one run to the next.
std::string make_run_page(const RunPage& page);

// Rows of the table of lights, as HTML.
std::string light_rows(const RunPage& page);

}  // namespace chiaro::cli

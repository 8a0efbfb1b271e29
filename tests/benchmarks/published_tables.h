#pragma once

#include <string>
#include <vector>

namespace chiaro::benchmarks {

// What is published of a solve; a case for ours.
struct PublishedRow {
  int important_vertices, lights;
  int exact_lights;  // that it was made to find; 0: as many as it takes
  std::string guessed_lights;
  double error_percent;
  double total_seconds = 0, initial_seconds = 0, optimal_seconds = 0;  // 0: not published
};

struct PublishedTable {
  std::string number, caption;
  std::vector<PublishedRow> rows;
};

// Of Y.-T. Chen, Lighting Design with Illumination Brush, 2008, chapter 4: all of its fiveballs scene.
std::vector<PublishedTable> published_tables();

}  // namespace chiaro::benchmarks

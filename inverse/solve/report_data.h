#pragma once
// What a report says, as JSON.

#include "inverse/solve/report.h"

namespace chiaro::inverse {

// The lights and the figures of every stage. Without seconds: the same solve gives the same text.
std::string stages_json(const SolveTrace& trace);

// All that the report's page shows, receivers and their values as data URIs (packed_values.h). Holds no "<", so that
// nothing in it ends a <script>, and is UTF-8 whatever the scene's names are.
std::string page_json(const SolveTrace& trace);

}  // namespace chiaro::inverse
